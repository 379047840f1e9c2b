// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.hpp"
#include "gridmerge/report/merge_record.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  MergeRecord record;
  try {
    record = parse_transforms("folder/transforms.json", fuzz::as_bytes(data, size));
  } catch (const FileError&) {
    return 0;
  }
  std::size_t placed = record.result.left_out.size();
  for (const Component& component : record.result.components) placed += component.members.size();
  fuzz::require(placed == record.names.size());
  // What was read can be written, and is then read as the same.
  const std::string text = transforms_json(record.names, record.result);
  const MergeRecord again = parse_transforms("folder/transforms.json", text);
  fuzz::require(transforms_json(again.names, again.result) == text);
  return 0;
}
