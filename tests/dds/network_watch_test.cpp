// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dds/network.hpp"

namespace gridmerge::internal {
namespace {

using Change = NetworkWatch::Change;

const NetworkAddresses kNone;
const NetworkAddresses kWifi{{"wlan0", 3, 0x0100000a}};
const NetworkAddresses kOtherAddress{{"wlan0", 3, 0x0900000a}};
const NetworkAddresses kMadeAnew{{"wlan0", 7, 0x0100000a}};
const NetworkAddresses kDocker{{"docker0", 4, 0x010011ac, false}};
const NetworkAddresses kBoth{{"docker0", 4, 0x010011ac, false}, {"wlan0", 3, 0x0100000a}};
const NetworkAddresses kUnplugged{{"eth0", 2, 0x0200000a, false}};
const NetworkAddresses kPluggedIn{{"eth0", 2, 0x0200000a}};

/// What a second look says: the first only sees that something has changed.
Change look_twice(NetworkWatch& watch, const NetworkAddresses& now) {
  EXPECT_EQ(watch.look(now), Change::none);
  return watch.look(now);
}

TEST(NetworkWatch, BeginsAnewWhereAFirstAddressComes) {
  NetworkWatch watch(kNone);
  EXPECT_EQ(look_twice(watch, kNone), Change::none);  // there was none to go
  EXPECT_EQ(look_twice(watch, kWifi), Change::replaced);
  EXPECT_EQ(watch.look(kWifi), Change::none);
}

TEST(NetworkWatch, BeginsAnewWhereAnAddressIsReplaced) {
  for (const NetworkAddresses& other : {kOtherAddress, kMadeAnew}) {
    NetworkWatch watch(kWifi);
    EXPECT_EQ(look_twice(watch, other), Change::replaced);
    EXPECT_EQ(watch.look(other), Change::none);
    EXPECT_EQ(look_twice(watch, kWifi), Change::replaced);
  }
}

TEST(NetworkWatch, WaitsForANetworkThatIsGone) {
  NetworkWatch watch(kWifi);
  EXPECT_EQ(look_twice(watch, kNone), Change::gone);
  EXPECT_EQ(watch.look(kNone), Change::none);         // it was told
  EXPECT_EQ(look_twice(watch, kWifi), Change::none);  // DDS finds what it began with
  EXPECT_EQ(look_twice(watch, kNone), Change::gone);
  EXPECT_EQ(look_twice(watch, kOtherAddress), Change::replaced);
}

TEST(NetworkWatch, StaysWhereMoreAddressesCome) {
  NetworkWatch watch(kWifi);
  EXPECT_EQ(look_twice(watch, kBoth), Change::none);
  EXPECT_EQ(look_twice(watch, kWifi), Change::none);
}

TEST(NetworkWatch, BeginsAnewWhereTheFirstThatLeadsOutComes) {
  NetworkWatch watch(kDocker);
  EXPECT_EQ(look_twice(watch, kBoth), Change::replaced);
  EXPECT_EQ(watch.begun_with(), kBoth);
  EXPECT_EQ(watch.look(kBoth), Change::none);
  // Without any network the bridge is the first there is.
  NetworkWatch late(kNone);
  EXPECT_EQ(look_twice(late, kDocker), Change::replaced);
  EXPECT_EQ(look_twice(late, kBoth), Change::replaced);
}

TEST(NetworkWatch, StaysWhereACarrierComesAndGoes) {
  NetworkWatch watch(kUnplugged);
  EXPECT_EQ(look_twice(watch, kPluggedIn), Change::none);
  EXPECT_EQ(look_twice(watch, kUnplugged), Change::none);
  EXPECT_EQ(look_twice(watch, kWifi), Change::replaced);
}

}  // namespace
}  // namespace gridmerge::internal
