// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "merge/coverage.hpp"
#include "merge/pose_graph.hpp"
#include "report/interchange_support.hpp"
#include "report/told_joins.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

/// The error of an edge as g2o has it: the inverse measurement times what the vertices say.
Eigen::Vector3d error_of(const Graph::Edge& edge, const std::map<std::size_t, Eigen::Vector3d>& poses) {
  const Eigen::Matrix3d off =
      edge.measurement.inverse() * matrix_of(poses.at(edge.from)).inverse() * matrix_of(poses.at(edge.to));
  return {off(0, 2), off(1, 2), std::atan2(off(1, 0), off(0, 0))};
}

/// Gauss and Newton's method with numeric derivatives.
void optimise(Graph& graph) {
  std::map<std::size_t, int> place;
  for (const auto& [id, pose] : graph.vertices) {
    if (graph.fixed.count(id) == 0) place.emplace(id, 3 * static_cast<int>(place.size()));
  }
  const int size = 3 * static_cast<int>(place.size());
  for (int round = 0; round < 12; ++round) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
    for (const Graph::Edge& edge : graph.edges) {
      const Eigen::Vector3d error = error_of(edge, graph.vertices);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, size);
      for (const std::size_t id : {edge.from, edge.to}) {
        if (place.count(id) == 0) continue;
        for (int k = 0; k < 3; ++k) {
          std::map<std::size_t, Eigen::Vector3d> moved{{edge.from, graph.vertices[edge.from]},
                                                       {edge.to, graph.vertices[edge.to]}};
          moved[id][k] += 1e-6;
          J.col(place[id] + k) = (error_of(edge, moved) - error) / 1e-6;
        }
      }
      H += J.transpose() * edge.information * J;
      b += J.transpose() * edge.information * error;
    }
    const Eigen::VectorXd step = H.ldlt().solve(-b);
    for (const auto& [id, at] : place) graph.vertices[id] += step.segment<3>(at);
  }
}

TEST(G2o, HasEveryPlacedMapAndEveryUsedJoin) {
  const Fleet fleet(30);
  const Graph graph = read_g2o(export_text(ExportFormat::g2o, fleet.named()));
  const std::vector<Member>& members = fleet.result.components[0].members;
  ASSERT_EQ(graph.vertices.size(), members.size());
  for (const Member& member : members)
    EXPECT_EQ(matrix_of(graph.vertices.at(member.map)), matrix_of(member.T_component_map));
  EXPECT_EQ(graph.fixed, std::set<std::size_t>{0});
  std::vector<const Join*> used;
  for (const Join& join : fleet.result.joins) {
    if (join.used()) used.push_back(&join);
  }
  ASSERT_EQ(graph.edges.size(), used.size());
  ASSERT_GT(used.size(), members.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    EXPECT_EQ(graph.edges[i].from, used[i]->fixed);
    EXPECT_EQ(graph.edges[i].to, used[i]->moving);
    EXPECT_EQ(graph.edges[i].measurement, matrix_of(used[i]->T_fixed_moving));
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(graph.edges[i].information).info(), Eigen::Success);
  }
}

TEST(G2o, IsSolvedByOthersToTheSamePoses) {
  const Fleet fleet(30);
  const Graph written = read_g2o(export_text(ExportFormat::g2o, fleet.named()));
  Graph solved = written;
  for (auto& [id, pose] : solved.vertices) {
    if (solved.fixed.count(id) == 0)
      pose += Eigen::Vector3d(0.3, -0.2, 0.05) * std::sin(static_cast<double>(id));
  }
  optimise(solved);
  for (const auto& [id, pose] : written.vertices)
    EXPECT_LT((matrix_of(solved.vertices[id]) - matrix_of(pose)).norm(), 1e-6) << id;
}

RC_GTEST_PROP(G2o, WeighsAnErrorAsTheMergeDoes, ()) {
  Fleet fleet(6);
  fleet.maps[0] = any_map();
  fleet.maps[1] = any_map();
  Join join = fleet.result.joins[0];
  join.T_fixed_moving = any_pose();
  const double sd = real_between(1, 3) / 10.0;
  join.match.hypotheses = {{join.T_fixed_moving, 1.0, 0.99}};
  set_deviation(join, sd);
  fleet.result.joins = {join};
  const Graph graph = read_g2o(export_text(ExportFormat::g2o, fleet.named()));
  RC_ASSERT(graph.edges.size() == 1u);
  const auto extent = [](const OccupancyGrid& map) { return Coverage(crop_to_known(map)).extent(); };
  const RelativePose measured =
      measured_between(0, 1, join.T_fixed_moving, extent(fleet.maps[0]), extent(fleet.maps[1]), sd);
  // How far a small error moves the place at which the deviations are known.
  const Eigen::Vector3d error(real_between(-1, 1) * 1e-6, real_between(-1, 1) * 1e-6,
                              real_between(-1, 1) * 1e-8);
  const Point2 p = measured.pivot, moved = SE2{error[0], error[1], error[2]} * p;
  const double expected = (std::pow(moved.x - p.x, 2) + std::pow(moved.y - p.y, 2)) / (sd * sd) +
                          std::pow(error[2] / measured.sd_theta, 2);
  const double weighed = error.dot(graph.edges[0].information * error);
  RC_ASSERT(std::abs(weighed - expected) <= 1e-4 * expected + 1e-18);
}

TEST(G2o, BeginsWithVerticesAndEdges) {
  // Some readers know these alone, and stop at anything else.
  const Fleet fleet(12);
  const std::string text = export_text(ExportFormat::g2o, fleet.named());
  EXPECT_GT(text.find("\nFIX "), text.rfind("\nEDGE_SE2 "));
  EXPECT_LT(text.rfind("\nVERTEX_SE2 "), text.find("\nEDGE_SE2 "));
  EXPECT_GT(text.find('#'), text.rfind("\nEDGE_SE2 "));
  EXPECT_EQ(text.find("VERTEX_SE2 "), 0u);
}

TEST(G2o, SaysWhereNoDeviationIsKnown) {
  Fleet fleet(6);
  Join join = fleet.result.joins[0];
  join.outcome = JoinOutcome::known;
  join.match.hypotheses.clear();
  fleet.result.joins = {join};
  const std::string text = export_text(ExportFormat::g2o, fleet.named());
  EXPECT_TRUE(contains(text, "# 0 to 1: no deviation is known")) << text;
  // That of agreement_tolerance(): half a metre for small maps.
  EXPECT_DOUBLE_EQ(read_g2o(text).edges.at(0).information(0, 0), 4.0);
}

TEST(G2o, FixesTheFixedMapsOfTheWorldsFrame) {
  Fleet fleet(8);
  Component& component = fleet.result.components[0];
  component.in_world_frame = true;
  for (Member& member : component.members) member.T_component_map.x += 5.0;
  component.members[2].sd = component.members[4].sd = PoseDeviation{};
  EXPECT_EQ(read_g2o(export_text(ExportFormat::g2o, fleet.named())).fixed, (std::set<std::size_t>{2, 4}));
  for (Member& member : component.members) member.sd = std::nullopt;
  EXPECT_EQ(read_g2o(export_text(ExportFormat::g2o, fleet.named())).fixed, std::set<std::size_t>{0});
}

TEST(G2o, FixesTheFirstMapOfEachPartOnAPlan) {
  Fleet fleet(8);
  Component& component = fleet.result.components[0];
  component.in_world_frame = true;
  for (Member& member : component.members) member.T_component_map.x += 5.0;
  fleet.result.plan = PlanPlacement{
      "plan", 1.0, {{{0, 1}, {}, 1.0, 0.99, Reason::none}, {{2, 3}, {}, 1.0, 0.99, Reason::none}}};
  EXPECT_EQ(read_g2o(export_text(ExportFormat::g2o, fleet.named())).fixed, (std::set<std::size_t>{0, 2}));
}

}  // namespace
}  // namespace gridmerge
