// SPDX-License-Identifier: Apache-2.0
#include "report/output_names.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>

namespace gridmerge {

using namespace internal;
namespace {

TEST(OutputNames, TheSecondIsNumberTwo) {
  EXPECT_EQ(numbered("a/b.tif", 0), "a/b.tif");
  EXPECT_EQ(numbered("a/b.tif", 1), "a/b_2.tif");
  EXPECT_EQ(numbered("b", 9), "b_10");
  EXPECT_EQ(numbered("a.b.tif", 2), "a.b_3.tif");
}

TEST(OutputNames, TellWhichMergedMapAFileIsOf) {
  using Number = std::optional<std::size_t>;
  EXPECT_EQ(number_in("m.tif", "m.tif"), Number(1));
  EXPECT_EQ(number_in("m_2.tif", "m.tif"), Number(2));
  EXPECT_EQ(number_in("m_10.tif", "m.tif"), Number(10));
  EXPECT_EQ(number_in("m_999999.tif", "m.tif"), Number(999999));
  for (const char* name :
       {"m_1000000.tif", "m_1.tif", "m_0.tif", "m_02.tif", "m_.tif", "m_2x.tif", "m_x2.tif", "m_-2.tif",
        "m_2.TIF", "m_2", "m2.tif", "n_2.tif", "mm_2.tif", "m_2_3.tif", "", "m_2 .tif", "_2.tif"})
    EXPECT_EQ(number_in(name, "m.tif"), std::nullopt) << name;
  // Whatever numbered() gives is known again.
  for (const std::size_t component : {0u, 1u, 2u, 8u, 9u, 10u, 98u, 99u, 12345u, 999998u})
    EXPECT_EQ(number_in(numbered("merged.yaml", component), "merged.yaml"), Number(component + 1));
}

TEST(OutputNames, AMergesOwnAreItsMapsItsPictureItsPageAndItsRecord) {
  for (const char* name : {"merged.yaml", "merged.pgm", "merged_2.yaml", "merged_17.pgm", "preview.png",
                           "report.html", "transforms.json"})
    EXPECT_TRUE(is_merge_output(name)) << name;
  for (const char* name : {"merged.tif", "merged_2.tif", "merged_1.yaml", "merged.png", "preview_2.png",
                           "report_2.html", "transforms.yaml", "merged", ""})
    EXPECT_FALSE(is_merge_output(name)) << name;
}

}  // namespace
}  // namespace gridmerge
