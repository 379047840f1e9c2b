// SPDX-License-Identifier: Apache-2.0
#include "building.hpp"

namespace gridmerge::example {

using namespace internal;

namespace {

void office_shell(Draughtsman& d) {
  d.window_front({0.0, 0.0}, {0.0, 25.0});
  d.window_front({0.0, 25.0}, {28.5, 25.0});
  d.wall({28.5, 25.0}, {28.5, 19.0});
  d.wall({28.5, 19.0}, {40.0, 19.0});
  d.window_front({40.0, 19.0}, {40.0, 3.5});
  d.wall({40.0, 3.5}, {31.0, 3.5});
  d.wall({31.0, 3.5}, {31.0, 0.0});
  d.wall({31.0, 0.0}, {23.1, 0.0}, {}, kGlass);
  d.window_front({23.1, 0.0}, {0.0, 0.0});

  // The corridor's two sides, the lobby opening off the northern one.
  d.wall({0.0, 10.6}, {40.0, 10.6},
         {{4.4, 0.9, -1},
          {7.0, 0.9, 0},
          {11.2, 1.0, -1},
          {17.1, 1.0, 0},
          {19.3, 0.9, -1},
          {24.4, 1.6, 0},
          {32.2, 1.0, 0}});
  d.wall({0.0, 12.8}, {22.5, 12.8}, {{6.3, 1.4, 1}, {9.2, 0.9, 0}, {15.3, 0.9, 1}, {18.0, 3.7, 0}});
  d.wall({22.5, 12.8}, {28.5, 12.8}, {{4.6, 0.9, 0}}, kGlass);
  d.wall({28.5, 12.8}, {40.0, 12.8}, {{0.9, 0.9, 1}, {8.4, 1.4, 0}});
}

void office_rooms(Draughtsman& d) {
  d.wall({6.2, 4.8}, {6.2, 10.6});
  d.wall({10.4, 0.0}, {10.4, 10.6});
  d.wall({0.0, 4.8}, {10.4, 4.8}, {{8.7, 0.9, 0}});
  d.wall({18.6, 0.0}, {18.6, 10.6});
  d.wall({18.6, 5.2}, {23.1, 5.2}, {{3.1, 0.9, -1}});
  d.wall({23.1, 0.0}, {23.1, 10.6});
  d.wall({31.0, 3.5}, {31.0, 10.6});
  d.wall({36.4, 3.5}, {36.4, 10.6}, {{4.9, 0.9, 0}});

  d.wall({8.3, 12.8}, {8.3, 25.0});
  d.wall({0.0, 19.5}, {4.6, 19.5});
  d.wall({12.1, 12.8}, {12.1, 18.0});
  d.wall({8.3, 18.0}, {17.0, 18.0}, {{2.2, 0.9, 1}});
  d.wall({17.0, 12.8}, {17.0, 25.0}, {{6.0, 1.0, 0}});
  d.wall({17.0, 20.5}, {28.5, 20.5}, {{1.2, 1.0, 1}});
  d.wall({22.5, 12.8}, {22.5, 20.5});
  d.wall({28.5, 12.8}, {28.5, 19.0});
  d.wall({34.3, 12.8}, {34.3, 19.0});
}

void office_furniture(Draughtsman& d) {
  // South side, west to east: two offices, the archive behind them, the meeting room, two more offices.
  d.desk({1.6, 6.4}, 1, 1);
  d.desk({4.2, 6.4}, -1, 1);
  d.box({0.4, 8.9}, 0.5, 1.8);
  d.desk({8.2, 6.3}, 1, 1);
  d.box({6.6, 8.4}, 0.45, 1.2);
  for (const double x : {1.3, 3.1, 4.9, 6.7}) d.box({x, 1.9}, 0.5, 2.9);
  d.table({14.3, 4.6}, 3.2, 1.3);
  for (const double x : {13.2, 14.4, 15.5}) {
    d.chair({x, 3.5});
    d.chair({x + 0.1, 5.8});
  }
  d.pillar({13.2, 8.0}, 0.22);
  d.pillar({16.6, 2.2}, 0.22);
  d.box({18.2, 5.6}, 0.45, 2.4);
  d.box({11.3, 0.6}, 1.4, 0.6);
  d.desk({20.1, 6.4}, -1, 1);
  d.box({22.7, 9.0}, 0.5, 1.4);
  d.desk({20.2, 1.4}, 1, 1);
  d.pillar({19.2, 4.6}, 0.2);

  // The open-plan office and the kitchen with its store.
  for (const double x : {25.2, 28.4}) {
    for (const double y : {2.2, 3.1}) d.desk({x, y}, x < 27.0 ? 1 : -1, y < 3.0 ? -1 : 1);
  }
  d.desk({28.6, 6.6}, 1, -1);
  d.box({25.6, 6.7}, 1.9, 0.8, {0.8, 0.6});
  d.pillar({27.0, 5.0}, 0.25);
  d.box({30.5, 8.6}, 0.6, 1.9);
  d.box({33.7, 3.95}, 4.2, 0.6);
  d.box({31.45, 5.4}, 0.6, 1.6);
  d.pillar({34.4, 6.6}, 0.12);
  for (const Point2& p : {Point2{33.6, 6.4}, Point2{35.2, 6.9}, Point2{34.3, 7.5}}) d.chair(p);
  d.box({38.6, 4.1}, 2.2, 0.7);
  d.box({39.6, 7.6}, 0.5, 3.0);

  // North side: the laboratory, the seminar room and its neighbours, the lobby.
  d.box({1.2, 16.4}, 0.8, 3.6);
  d.box({3.7, 16.1}, 0.9, 2.6);
  d.pillar({6.2, 18.3}, 0.25);
  d.desk({1.6, 24.2}, 1, -1);
  d.table({5.4, 23.7}, 2.2, 0.9);
  d.box({7.9, 22.4}, 0.5, 1.8);
  d.desk({10.2, 16.6}, -1, -1);
  d.desk({13.7, 16.9}, 1, -1);
  d.box({16.6, 16.4}, 0.5, 1.6);
  for (const double y : {20.4, 22.0, 23.6}) {
    d.table({13.2, y}, 4.2, 0.6);
    for (const double x : {11.6, 13.0, 14.4}) d.chair({x, y - 0.7});
  }
  d.pillar({19.0, 15.4}, 0.25);
  d.pillar({21.2, 16.6}, 0.25);
  d.box({21.4, 19.4}, 2.0, 2.0);
  d.box({17.5, 16.4}, 0.7, 1.9, {0.98, 0.2});

  // The corner office, the glazed one, and the two in the east.
  d.desk({21.2, 24.2}, 1, -1);
  d.desk({24.6, 24.2}, -1, -1);
  d.box({27.9, 22.6}, 0.7, 2.2);
  d.pillar({22.6, 22.4}, 0.2);
  d.table({25.0, 17.2}, 2.4, 1.2);
  for (const Point2& p : {Point2{24.4, 16.2}, Point2{25.8, 18.1}, Point2{23.5, 17.4}}) d.chair(p);
  d.box({23.0, 14.4}, 0.5, 1.6);
  d.desk({31.0, 18.0}, -1, -1);
  d.desk({32.9, 15.2}, 1, 1);
  d.box({28.95, 16.6}, 0.5, 2.0);
  d.desk({36.0, 17.9}, 1, -1);
  d.desk({38.6, 17.9}, -1, -1);
  d.box({38.9, 14.4}, 1.3, 0.8, {0.6, 0.8});

  // What people leave in corridors.
  d.box({2.6, 12.5}, 1.3, 0.4);
  d.box({13.9, 10.9}, 0.9, 0.4);
  d.pillar({30.9, 10.9}, 0.18);
  d.box({34.6, 12.5}, 1.7, 0.4);
}

}  // namespace

Building office_floor() {
  Draughtsman d;
  office_shell(d);
  office_rooms(d);
  office_furniture(d);
  return d.edges;
}

Building workshop() {
  Draughtsman d;
  d.wall({0.0, 0.0}, {27.0, 0.0});
  d.wall({27.0, 0.0}, {27.0, 9.5});
  d.wall({27.0, 9.5}, {20.5, 17.0});
  d.window_front({20.5, 17.0}, {0.0, 17.0});
  d.wall({0.0, 17.0}, {0.0, 0.0});
  d.wall({0.0, 5.4}, {11.5, 5.4}, {{2.1, 1.0, 1}, {7.9, 1.0, 0}});
  d.wall({5.3, 0.0}, {5.3, 5.4});
  d.wall({11.5, 0.0}, {11.5, 5.4});
  d.wall({19.0, 0.0}, {19.0, 6.2}, {{4.0, 1.2, 0}});
  d.wall({19.0, 6.2}, {27.0, 6.2}, {{5.2, 1.0, -1}});
  d.desk({1.7, 1.1}, 1, 1);
  d.box({4.8, 2.6}, 0.5, 2.4);
  d.table({8.4, 2.2}, 2.0, 1.0);
  d.chair({8.0, 3.2});
  d.chair({9.3, 1.2});
  d.box({4.2, 8.9}, 2.8, 1.5);
  d.box({4.9, 13.4}, 1.6, 3.0);
  d.box({10.6, 9.8}, 3.4, 1.2, {0.9, 0.4});
  d.pillar({8.6, 12.9}, 0.3);
  d.pillar({15.2, 12.9}, 0.3);
  d.pillar({15.2, 7.4}, 0.3);
  d.box({12.2, 15.6}, 4.4, 0.9);
  d.box({18.6, 10.2}, 1.2, 2.6, {0.7, -0.5});
  d.box({16.4, 1.2}, 3.2, 0.8);
  d.table({14.2, 4.6}, 1.8, 0.8);
  d.box({22.4, 8.4}, 2.2, 0.9);
  d.box({20.2, 13.6}, 0.8, 1.6, {0.65, 0.76});
  d.box({25.9, 2.6}, 0.9, 3.2);
  d.desk({21.3, 1.2}, -1, 1);
  return d.edges;
}

}  // namespace gridmerge::example
