// SPDX-License-Identifier: Apache-2.0
#include "online/group_numbers.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <initializer_list>

#include "online/status.hpp"

namespace gridmerge::internal {
namespace {

/// Robots that were heard in the order of their names, and what is told of their groups.
class Numbered {
 public:
  explicit Numbered(const std::string& robots) {
    for (const char name : robots) ages_[{name}] = TeamTime(std::chrono::seconds(name));
  }

  /// A robot is a letter; a group in the frame of fixed poses begins with a '!'. Returns what is told of
  /// them: "1: ab 2: cde".
  std::string tell(std::initializer_list<std::string> groups, bool is_world_known = false) {
    std::vector<RobotGroup> all;
    for (std::string group : groups) {
      all.emplace_back();
      all.back().in_world_frame = group.starts_with('!');
      if (all.back().in_world_frame) group.erase(0, 1);
      for (const char name : group) all.back().robots[{name}] = {};
    }
    const std::vector<std::size_t> numbers = numbers_.number(all, ages_, is_world_known);
    std::map<std::size_t, TeamComponent> components;
    for (std::size_t i = 0; i < all.size(); ++i) {
      TeamComponent& component = components[numbers[i]];
      EXPECT_TRUE(component.robots.empty()) << "two groups of one number";
      component.number = numbers[i];
      for (const auto& [robot, placement] : all[i].robots) component.robots.push_back(robot);
    }
    std::vector<TeamComponent> told;
    std::string text;
    for (const auto& [number, component] : components) {
      told.push_back(component);
      text += (text.empty() ? "" : " ") + std::to_string(number) + ": ";
      for (const std::string& robot : component.robots) text += robot;
    }
    events = renumbered_between(numbers_.told(), told);
    numbers_.keep(told, ages_);
    return text;
  }

  void remove(const std::string& robot) { ages_.erase(robot); }

  std::vector<TeamEvent> events;  // of what was told last

 private:
  GroupNumbers numbers_;
  std::map<std::string, TeamTime> ages_;
};

TEST(GroupNumbers, StayWhenALargerGroupComes) {
  Numbered numbered("abcde");
  EXPECT_EQ(numbered.tell({"ab"}), "1: ab");
  EXPECT_EQ(numbered.tell({"cde", "ab"}), "1: ab 2: cde");
  EXPECT_EQ(numbered.tell({"ab", "cd"}), "1: ab 2: cd");
  EXPECT_EQ(numbered.tell({"cde", "ab"}), "1: ab 2: cde");
  EXPECT_TRUE(numbered.events.empty());
}

TEST(GroupNumbers, StayWhenAnOlderGroupComes) {
  Numbered numbered("abcd");
  EXPECT_EQ(numbered.tell({"cd"}), "1: cd");
  EXPECT_EQ(numbered.tell({"ab", "cd"}), "1: cd 2: ab");
}

TEST(GroupNumbers, AreByAgeWhereAllGroupsAreNew) {
  Numbered numbered("abcdefgh");
  EXPECT_EQ(numbered.tell({"egh", "bf", "ad"}), "1: ad 2: bf 3: egh");
}

TEST(GroupNumbers, StayWhenAnotherGroupGoesAndComesBack) {
  Numbered numbered("abcdef");
  EXPECT_EQ(numbered.tell({"ab", "cd"}), "1: ab 2: cd");
  EXPECT_EQ(numbered.tell({"cd"}), "2: cd");
  EXPECT_EQ(numbered.tell({"ab", "cd"}), "1: ab 2: cd");
  EXPECT_TRUE(numbered.events.empty());
  // A free number is given anew, and whose it was is told of another.
  EXPECT_EQ(numbered.tell({"cd"}), "2: cd");
  EXPECT_EQ(numbered.tell({"cd", "ef"}), "1: ef 2: cd");
  EXPECT_EQ(numbered.tell({"ab", "cd", "ef"}), "1: ef 2: cd 3: ab");
  ASSERT_EQ(numbered.events.size(), 1u);
  EXPECT_EQ(numbered.events[0].kind, TeamEvent::Kind::renumbered);
  EXPECT_EQ(numbered.events[0].robot, "a");
  EXPECT_EQ(numbered.events[0].text, "a, b: now in merged map 3, before in merged map 1");
}

TEST(GroupNumbers, OfGroupsThatBecomeOneTheLeastStays) {
  Numbered numbered("abcdef");
  EXPECT_EQ(numbered.tell({"ef"}), "1: ef");
  EXPECT_EQ(numbered.tell({"ef", "abcd"}), "1: ef 2: abcd");
  EXPECT_EQ(numbered.tell({"abcdef"}), "1: abcdef");
  ASSERT_EQ(numbered.events.size(), 1u);
  EXPECT_EQ(numbered.events[0].text, "a, b, c, d: now in merged map 1, before in merged map 2");
}

TEST(GroupNumbers, GoWithTheOldestWhereAGroupComesApart) {
  Numbered numbered("abcde");
  EXPECT_EQ(numbered.tell({"abcde"}), "1: abcde");
  EXPECT_EQ(numbered.tell({"cde", "ab"}), "1: ab 2: cde");
  ASSERT_EQ(numbered.events.size(), 1u);
  EXPECT_EQ(numbered.events[0].robot, "c");
}

TEST(GroupNumbers, AreOfThoseWhoLieInTheGroupMoreThanOfThoseWhoDid) {
  Numbered numbered("abcde");
  EXPECT_EQ(numbered.tell({"abc", "de"}), "1: abc 2: de");
  EXPECT_EQ(numbered.tell({"bc", "de"}), "1: bc 2: de");
  EXPECT_EQ(numbered.tell({"bc", "ade"}), "1: bc 2: ade") << "a lay nowhere meanwhile";
}

TEST(GroupNumbers, NumberOneIsThatOfTheFrameOfFixedPoses) {
  Numbered numbered("abcdef");
  EXPECT_EQ(numbered.tell({"ab"}, true), "2: ab") << "the frame of the poses is not theirs";
  EXPECT_EQ(numbered.tell({"ab", "!ef"}, true), "1: ef 2: ab");
  EXPECT_EQ(numbered.tell({"!abef", "cd"}, true), "1: abef 2: cd");
  EXPECT_EQ(numbered.tell({"abef", "cd"}), "1: abef 2: cd") << "the poses hold no longer";
}

TEST(GroupNumbers, ForgetWhoIsGone) {
  Numbered numbered("abcd");
  EXPECT_EQ(numbered.tell({"ab", "cd"}), "1: ab 2: cd");
  numbered.remove("a");
  numbered.remove("b");
  EXPECT_EQ(numbered.tell({"cd"}), "2: cd");
}

}  // namespace
}  // namespace gridmerge::internal
