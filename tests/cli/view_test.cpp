// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <limits>
#include <thread>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

constexpr const char* kJson = "application/json";

/// `gridmerge view` of two maps that were merged, and one that was left out.
class View : public CliTest {
 protected:
  View() {
    EXPECT_EQ(run({"merge", left, right, other, "-o", output}).exit_code, 3);
    server = std::make_unique<RunningProgram>(std::vector<std::string>{"view", output});
    const std::string line = server->read_line();
    const std::string start = "http://127.0.0.1:";
    EXPECT_EQ(line.find(start), 0u) << line;
    port = std::stoi(line.substr(start.size()));
    host = "127.0.0.1:" + std::to_string(port);
  }

  httplib::Client client() const { return httplib::Client("127.0.0.1", port); }

  /// A question about the second map, displaced from where it lies on the first.
  Json question() const {
    const Json members =
        Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
    Json transform = members.at(1).at("transform");
    transform["x"] = transform.at("x").get<double>() + 0.4;
    transform["y"] = transform.at("y").get<double>() - 0.3;
    return {{"moving", 1},
            {"transform", transform},
            {"fixed", {{{"map", 0}, {"transform", members.at(0).at("transform")}}}}};
  }

  /// What the server answers to raw bytes.
  std::string exchange(const std::string& bytes) const {
    const int connection = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    const timeval patience{10, 0};
    ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    std::string answer;
    std::array<char, 4096> block{};
    for (ssize_t count = 0; (count = ::recv(connection, block.data(), block.size(), 0)) > 0;)
      answer.append(block.data(), static_cast<std::size_t>(count));
    ::close(connection);
    return answer;
  }

  void expect_alive() const {
    const auto page = client().Get("/");
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
  }

  const std::string output = directory.file("out");
  std::unique_ptr<RunningProgram> server;
  int port = 0;
  std::string host;
};

TEST_F(View, ServesTheLivePage) {
  const auto page = client().Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(page->get_header_value("Content-Security-Policy"), "frame-ancestors 'none'");
  EXPECT_FALSE(page->has_header("Access-Control-Allow-Origin"));
  EXPECT_NE(page->body.find("connect-src 'self'; "), std::string::npos);
  // But for these two it is the page that the merge wrote.
  std::string file = read_file(output + "/report.html");
  file.replace(file.find("connect-src 'none'"), 18, "connect-src 'self'");
  file.replace(file.find("\"live\":false"), 12, "\"live\":true");
  EXPECT_TRUE(page->body == file);
}

TEST_F(View, RefinesAPoseThatWasLaidByHand) {
  const auto answer = client().Post("/refine", question().dump(), kJson);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(answer->get_header_value("Content-Type"), kJson);
  EXPECT_EQ(answer->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_FALSE(answer->has_header("Access-Control-Allow-Origin"));
  const Json json = Json::parse(answer->body);
  expect_keys(json, {"transform", "score", "probability", "acceptance_index", "agreement", "disagreement",
                     "overlap", "start_score", "moved"});
  expect_near(json.at("transform"), T_left_right, 0.1, 0.007);
  EXPECT_GE(json.at("probability"), 0.8);
  EXPECT_GT(json.at("score"), json.at("start_score"));
  EXPECT_NEAR(json.at("moved"), 0.5, 0.1);
  EXPECT_GT(json.at("acceptance_index"), 0.9);
}

TEST_F(View, OfAMapThatDoesNotBelongItSaysSo) {
  Json body = question();
  body["fixed"].push_back({{"map", 1}, {"transform", body.at("transform")}});
  body["moving"] = 2;
  const auto answer = client().Post("/refine", body.dump(), "application/json; charset=utf-8");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_LT(Json::parse(answer->body).at("probability"), 0.1);
}

TEST_F(View, NamesWhatIsWrongWithABody) {
  const auto expect_bad = [&](const std::string& body, const std::string& error) {
    const auto answer = client().Post("/refine", body, kJson);
    ASSERT_TRUE(answer) << body;
    EXPECT_EQ(answer->status, 400) << body << answer->body;
    const Json json = Json::parse(answer->body);
    expect_keys(json, {"error"});
    EXPECT_NE(json.at("error").get<std::string>().find(error), std::string::npos) << answer->body;
  };
  const auto changed = [&](const char* pointer, const Json& value) {
    Json body = question();
    body[Json::json_pointer(pointer)] = value;
    return body.dump();
  };
  expect_bad("", "JSON");
  expect_bad("{", "JSON");
  expect_bad("\xff\xfe", "JSON");
  expect_bad(std::string(100000, '['), "JSON");
  expect_bad("[]", "object");
  expect_bad("{}", "moving");
  expect_bad(changed("/moving", 3), "moving is no map");
  expect_bad(changed("/moving", -1), "moving");
  expect_bad(changed("/moving", 0), "fixed[0].map is the moving map");
  expect_bad(changed("/transform/x", "NaN"), "transform.x");
  expect_bad(changed("/transform/y", 1e8), "transform.y");
  expect_bad(changed("/transform/theta", nullptr), "transform.theta");
  expect_bad(changed("/fixed", Json::array()), "fixed holds no map");
  expect_bad(changed("/fixed/0/map", 1.5), "fixed[0].map");
  Json twice = question();
  twice["fixed"].push_back(twice["fixed"][0]);
  expect_bad(twice.dump(), "fixed[1].map is there twice");
  Json apart = question();
  apart["fixed"].push_back({{"map", 2}, {"transform", {{"x", 1e6}, {"y", 1e6}, {"theta", 0}}}});
  expect_bad(apart.dump(), "the fixed maps");
  expect_alive();
}

TEST_F(View, TakesNoMoreThanAMebibyte) {
  const auto answer = client().Post("/refine", std::string((1u << 20) + 1, ' '), kJson);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 413);
  // A few bytes that unfold to many are not unfolded.
  httplib::Headers headers{{"Content-Encoding", "gzip"}};
  const auto folded = client().Post("/refine", headers, "\x1f\x8b", kJson);
  ASSERT_TRUE(folded);
  EXPECT_EQ(folded->status, 415);
  expect_alive();
}

TEST_F(View, ServesNoFile) {
  for (const char* path :
       {"/report.html", "/transforms.json", "/merged.pgm", "/../left.yaml", "/..%2fleft.yaml",
        "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/./", "/refine", "/%00", "/index.html"}) {
    const auto answer = client().Get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 404) << path;
    EXPECT_EQ(answer->body, "{\"error\":\"there is nothing here\"}\n") << path;
  }
  EXPECT_EQ(client().Post("/", "{}", kJson)->status, 404);
  EXPECT_EQ(client().Delete("/")->status, 404);
  EXPECT_EQ(client().Options("/refine")->status, 404);
  EXPECT_EQ(client().Put("/refine", "{}", kJson)->status, 404);
}

TEST_F(View, AnswersItsOwnPageAlone) {
  const std::string body = question().dump();
  const auto status = [&](const httplib::Headers& headers, const char* type = kJson) {
    const auto answer = client().Post("/refine", headers, body, type);
    return answer ? answer->status : -1;
  };
  const std::string at = host.substr(host.find(':'));
  for (const std::string& own : {"127.0.0.1" + at, "localhost" + at, "[::1]" + at}) {
    EXPECT_EQ(status({{"Host", own}, {"Origin", "http://" + own}}), 200) << own;
  }
  for (const std::string& foreign :
       {std::string("example.org"), "example.org" + at, std::string("localhost"), std::string("localhost:1"),
        "localhost" + at + ".example.org", "127.0.0.1.example.org" + at, std::string("")}) {
    EXPECT_EQ(status({{"Host", foreign}}), 403) << foreign;
    httplib::Headers headers{{"Host", foreign}};
    EXPECT_EQ(client().Get("/", headers)->status, 403) << foreign;
  }
  for (const std::string& foreign :
       {std::string("http://example.org"), "https://127.0.0.1" + at, std::string("null"),
        std::string("http://localhost"), "127.0.0.1" + at}) {
    EXPECT_EQ(status({{"Origin", foreign}}), 403) << foreign;
  }
  // What a form on another site can send without asking first.
  for (const char* type :
       {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
        "text/plain; application/json", "application/jsonp"})
    EXPECT_EQ(status({}, type), 415) << type;
  EXPECT_EQ(exchange("GET / HTTP/1.0\r\n\r\n").find("HTTP/1.1 403"), 0u);
  EXPECT_EQ(
      exchange("GET / HTTP/1.1\r\nHost: " + host + "\r\nHost: example.org\r\n\r\n").find("HTTP/1.1 403"), 0u);
}

TEST_F(View, OutlivesGarbage) {
  for (const std::string& bytes :
       {std::string("\r\n\r\n"), std::string("\0\xff\x01\n\n", 5), std::string(100000, 'A'),
        std::string("GET\r\n\r\n"), "GET / HTTP/9.9\r\nHost: " + host + "\r\n\r\n",
        "POST /refine HTTP/1.1\r\nHost: " + host +
            "\r\nContent-Type: application/json\r\nContent-Length: -1\r\n\r\n{}",
        "POST /refine HTTP/1.1\r\nHost: " + host +
            "\r\nContent-Type: application/json\r\nContent-Length: 99\r\n\r\n{}",
        "POST /refine HTTP/1.1\r\nHost: " + host +
            "\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n{}",
        "GET / HTTP/1.1\r\nHost: " + host + "\r\nRange: bytes=5-1,-9-\r\n\r\n"}) {
    EXPECT_EQ(exchange(bytes).find("HTTP/1.1 200"), std::string::npos) << bytes.substr(0, 200);
    expect_alive();
  }
}

TEST_F(View, AnswersSeveralAtOnce) {
  const std::string body = question().dump();
  std::vector<std::string> answers(6);
  std::vector<std::thread> askers;
  for (std::string& answer : answers) {
    askers.emplace_back([&] {
      const auto found = client().Post("/refine", body, kJson);
      answer = found ? found->body : "";
    });
  }
  for (std::thread& asker : askers) asker.join();
  for (const std::string& answer : answers) EXPECT_EQ(answer, answers.front());
  EXPECT_NE(answers.front(), "");
}

TEST_F(View, EndsWithCtrlC) {
  const Outcome outcome = server->end_with(SIGINT);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(View, EndsWithCtrlCWhileSomebodyIsConnectedAndSilent) {
  const int connection = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(server->end_with(SIGTERM).exit_code, 0);
  ::close(connection);
}

TEST_F(View, APortThatIsTakenIsAnError) {
  RunningProgram second({"view", output, "--port", std::to_string(port)});
  ASSERT_EQ(second.read_line(), "") << "it serves";
  expect_error(second.end_with(SIGTERM), host, "already in use; choose another --port");
}

TEST_F(View, AnAddressThatIsNotThisMachinesIsAnError) {
  expect_error(run({"view", output, "--address", "192.0.2.1"}), "192.0.2.1", "");
}

TEST_F(View, NeedsWhatReportNeeds) {
  expect_error(run({"view", directory.path()}), directory.path(), "no transforms.json");
  std::filesystem::remove(right);
  expect_error(run({"view", output}), right, "--root");
}

}  // namespace
}  // namespace gridmerge::test
