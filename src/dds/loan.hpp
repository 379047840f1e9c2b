// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <string_view>

#include "dds/entity.hpp"

namespace gridmerge::internal {

/// A text of a sample; empty for none.
inline std::string_view text_of(const char* text) {
  return text == nullptr ? std::string_view() : std::string_view(text);
}

/// A sample that is read where Cyclone DDS keeps it.
class Loan {
 public:
  explicit Loan(dds_entity_t reader) : reader_(reader) {
    count_ = require_dds(dds_take(reader_, &sample_, &info_, 1, 1), "what was received");
  }
  ~Loan() {
    if (count_ > 0) dds_return_loan(reader_, &sample_, count_);
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

  bool is_there() const { return count_ > 0; }
  const dds_sample_info_t& info() const { return info_; }
  template <typename Sample>
  const Sample& as() const {
    return *static_cast<const Sample*>(sample_);
  }

 private:
  dds_entity_t reader_;
  void* sample_ = nullptr;
  dds_sample_info_t info_{};
  std::int32_t count_ = 0;
};

}  // namespace gridmerge::internal
