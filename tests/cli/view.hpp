// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fixture.hpp"
#include "http_client.hpp"

namespace gridmerge::test {

inline constexpr const char* kJson = "application/json";

/// Of the line in which `gridmerge view` says where it serves.
inline int port_of(const std::string& line) {
  const std::string start = "http://127.0.0.1:";
  EXPECT_EQ(line.find(start), 0u) << line;
  return std::stoi(line.substr(start.size()));
}

/// What a page was given.
inline Json data_of_page(const std::string& html) {
  const std::string start = R"(id="report-data">)";
  const std::size_t from = html.find(start) + start.size();
  return Json::parse(html.substr(from, html.find("</script>", from) - from));
}

/// `gridmerge view` of two maps that were merged, and one that was left out.
class View : public CliTest {
 protected:
  View() {
    EXPECT_EQ(run({"merge", left, right, other, "-o", output}).exit_code, 3);
    server = std::make_unique<RunningProgram>(std::vector<std::string>{"view", output});
    port = port_of(server->read_line());
    host = "127.0.0.1:" + std::to_string(port);
  }

  HttpClient client() const { return HttpClient(port); }

  /// What the page was given, as the merge wrote it.
  Json page_data() const { return data_of_page(read_file(output + "/report.html")); }

  /// A question about the second map, displaced from where it lies on the first.
  Json question() const {
    const Json members =
        Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
    Json transform = members.at(1).at("transform");
    transform["x"] = transform.at("x").get<double>() + 0.4;
    transform["y"] = transform.at("y").get<double>() - 0.3;
    return {{"merge", page_data().at("merge")},
            {"moving", 1},
            {"transform", transform},
            {"fixed", {{{"map", 0}, {"transform", members.at(0).at("transform")}}}}};
  }

  Connection connect() const { return Connection(port); }

  /// What the server answers to raw bytes.
  std::string exchange(const std::string& bytes) const {
    const Connection connection = connect();
    EXPECT_TRUE(connection.send(bytes));
    return connection.receive(10);
  }

  /// The head of a question, but for what it says of its body's length.
  std::string head(const std::string& method = "POST") const {
    return method + " /refine HTTP/1.1\r\nHost: " + host + "\r\nContent-Type: application/json\r\n";
  }

  void expect_alive() const {
    const auto page = client().get("/");
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
  }

  const std::string output = directory.file("out");
  std::unique_ptr<RunningProgram> server;
  int port = 0;
  std::string host;
};

}  // namespace gridmerge::test
