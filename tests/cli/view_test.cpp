// SPDX-License-Identifier: Apache-2.0
#include "view.hpp"

#include <ifaddrs.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

namespace gridmerge::test {
namespace {

TEST_F(View, ServesTheLivePage) {
  const auto page = client().get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->header("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(page->header("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(page->header("Content-Security-Policy"), "frame-ancestors 'none'");
  EXPECT_FALSE(page->has_header("Access-Control-Allow-Origin"));
  EXPECT_NE(page->body.find("connect-src 'self'; "), std::string::npos);
  // But for these two it is the page that the merge wrote.
  std::string file = read_file(output + "/report.html");
  file.replace(file.find("connect-src 'none'"), 18, "connect-src 'self'");
  file.replace(file.find("\"live\":false"), 12, "\"live\":true");
  EXPECT_TRUE(page->body == file);
}

TEST_F(View, RefinesAPoseThatWasLaidByHand) {
  const auto answer = client().post("/refine", question().dump(), kJson);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(answer->header("Content-Type"), kJson);
  EXPECT_EQ(answer->header("X-Content-Type-Options"), "nosniff");
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
  const auto answer = client().post("/refine", body.dump(), "application/json; charset=utf-8");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200) << answer->body;
  EXPECT_LT(Json::parse(answer->body).at("probability"), 0.1);
}

// The same numbers stand for other maps there.
TEST_F(View, OfAnotherMergeItAnswersNothing) {
  Json body = question();
  body["merge"] = "0123456789abcdef";
  body["moving"] = 99;
  const auto answer = client().post("/refine", body.dump(), kJson);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 409);
  EXPECT_EQ(Json::parse(answer->body), Json({{"error", "this page is of another merge: reload it"}}));
}

TEST_F(View, NamesWhatIsWrongWithABody) {
  const auto expect_bad = [&](const std::string& body, const std::string& error) {
    const auto answer = client().post("/refine", body, kJson);
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
  expect_bad("{}", "merge");
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
  const auto answer = client().post("/refine", std::string((1u << 20) + 1, ' '), kJson);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 413);
  // A few bytes that unfold to many are not unfolded.
  HttpHeaders headers{{"Content-Encoding", "gzip"}};
  const auto folded = client().post("/refine", "\x1f\x8b", kJson, headers);
  ASSERT_TRUE(folded);
  EXPECT_EQ(folded->status, 415);
  expect_alive();
}

TEST_F(View, ABodyOfUntoldLengthIsNotRead) {
  const std::string body = question().dump();
  const auto length = [](const std::string& text) {
    return "Content-Length: " + std::to_string(text.size()) + "\r\n";
  };
  ASSERT_EQ(exchange(head() + length(body) + "\r\n" + body).find("HTTP/1.1 200"), 0u);
  const auto expect_refused = [&](const std::string& bytes) {
    const std::string answer = exchange(bytes);
    EXPECT_EQ(answer.find("HTTP/1.1 411"), 0u) << answer.substr(0, 300);
    EXPECT_NE(answer.find("Content-Length\"}"), std::string::npos) << answer.substr(0, 300);
    expect_alive();
  };
  std::string chunked = head() + "Transfer-Encoding: chunked\r\n\r\n";
  for (const char c : body) chunked += std::string("1\r\n") + c + "\r\n";
  chunked += "0\r\n\r\n";
  expect_refused(chunked);
  expect_refused(head() + length(body) + "Transfer-Encoding: chunked\r\n\r\n" + body);
  expect_refused(head() + "\r\n" + body);
  expect_refused(head() + length(body) + length("") + "\r\n" + body);
  // Of other methods no body is wanted at all.
  for (const char* method : {"PUT", "PATCH", "DELETE"})
    EXPECT_EQ(exchange(head(method) + "\r\n" + body).find("HTTP/1.1 404"), 0u) << method;
}

TEST_F(View, SendsNoPageManyTimesOver) {
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 1000; ++i) ranges += ",0-";
  for (const std::string& range : {ranges, std::string("Range: bytes=0-0")}) {
    for (const std::string& start :
         {"GET / HTTP/1.1\r\nHost: " + host + "\r\n", std::string("GET / HTTP/1.1\r\nHost: example.org\r\n"),
          head() + "Content-Length: 9999999\r\n"}) {
      const std::string answer = exchange(start + range + "\r\n\r\n");
      EXPECT_EQ(answer.find("HTTP/1.1 416"), 0u) << answer.substr(0, 300);
      EXPECT_LT(answer.size(), 1000u);
    }
  }
  expect_alive();
}

TEST_F(View, ServesNoFile) {
  for (const char* path :
       {"/report.html", "/transforms.json", "/merged.pgm", "/../left.yaml", "/..%2fleft.yaml",
        "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/./", "/refine", "/%00", "/index.html"}) {
    const auto answer = client().get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 404) << path;
    EXPECT_EQ(answer->body, "{\"error\":\"there is nothing here\"}\n") << path;
  }
  EXPECT_EQ(client().post("/", "{}", kJson)->status, 404);
  EXPECT_EQ(client().ask("DELETE", "/")->status, 404);
  EXPECT_EQ(client().ask("OPTIONS", "/refine")->status, 404);
  EXPECT_EQ(client().ask("PUT", "/refine", {{"Content-Type", kJson}}, "{}")->status, 404);
}

TEST_F(View, AnswersItsOwnPageAlone) {
  const std::string body = question().dump();
  const auto status = [&](const HttpHeaders& headers, const char* type = kJson) {
    const auto answer = client().post("/refine", body, type, headers);
    return answer ? answer->status : -1;
  };
  const std::string at = host.substr(host.find(':'));
  for (const std::string& own : {"127.0.0.1" + at, "localhost" + at, "[::1]" + at, "LocalHost" + at}) {
    EXPECT_EQ(status({{"Host", own}, {"Origin", "http://" + own}}), 200) << own;
  }
  for (const std::string& foreign :
       {std::string("example.org"), "example.org" + at, std::string("localhost"), std::string("localhost:1"),
        "localhost" + at + ".example.org", "127.0.0.1.example.org" + at, std::string("")}) {
    EXPECT_EQ(status({{"Host", foreign}}), 403) << foreign;
    HttpHeaders headers{{"Host", foreign}};
    EXPECT_EQ(client().get("/", headers)->status, 403) << foreign;
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
      const auto found = client().post("/refine", body, kJson);
      answer = found ? found->body : "";
    });
  }
  for (std::thread& asker : askers) asker.join();
  for (const std::string& answer : answers) EXPECT_EQ(answer, answers.front());
  EXPECT_NE(answers.front(), "");
}

TEST_F(View, AFullDeviceIsAnError) {
  RunOptions options;
  options.stdout_to = "/dev/full";
  expect_error(run({"view", output}, options), "standard output", "No space left");
}

/// An address of this machine by which others can reach it; "" when there is none.
std::string outward_address() {
  ifaddrs* found = nullptr;
  if (::getifaddrs(&found) != 0) return "";
  std::string address;
  for (const ifaddrs* entry = found; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, NI_MAXHOST> number{};
    ::getnameinfo(entry->ifa_addr, sizeof(sockaddr_in), number.data(), number.size(), nullptr, 0,
                  NI_NUMERICHOST);
    if (!std::string(number.data()).starts_with("127.")) address = number.data();
  }
  ::freeifaddrs(found);
  return address;
}

TEST_F(View, WarnsOfOthersWhereOthersCanReachIt) {
  const auto serve_at = [&](const std::string& address) {
    RunningProgram program({"view", output, "--address", address});
    const std::string line = program.read_line();
    const std::string start =
        "http://" + (address.find(':') == std::string::npos ? address : "[" + address + "]") + ":";
    EXPECT_EQ(line.find(start), 0u) << line;
    // Browsers spell the address in their own way.
    const int at = std::atoi(line.substr(start.size()).c_str());
    if (address.starts_with("127")) {
      EXPECT_EQ(HttpClient(at).get("/")->status, 200);
    }
    return program.end_with(SIGTERM).err;
  };
  std::vector<std::string> local{"127.0.0.1", "127.1", "localhost"};
  const int probe = ::socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (probe >= 0) local.emplace_back("::ffff:127.0.0.1");
  ::close(probe);
  for (const std::string& address : local) EXPECT_EQ(serve_at(address), "") << address;
  const std::string outward = outward_address();
  if (outward.empty()) GTEST_SKIP() << "this machine has no other address";
  EXPECT_NE(serve_at(outward).find("whoever reaches"), std::string::npos) << outward;
}

TEST_F(View, APortThatIsTakenIsAnError) {
  RunningProgram second({"view", output, "--port", std::to_string(port)});
  ASSERT_EQ(second.read_line(), "") << "it serves";
  expect_error(second.end_with(SIGTERM), host, "already in use; choose another port");
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
