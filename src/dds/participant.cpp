// SPDX-License-Identifier: Apache-2.0
#include "dds/participant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "dds/line_limiter.hpp"
#include "gridmerge/export.hpp"

// These two take the place of Cyclone DDS's own, which the dynamic linker finds later than the program's.
// They deal with descriptions of types that participants ask each other for. ROS 2 needs none: a type is
// known by its name. And Cyclone DDS 0.10.2 crashes over what nodes of ROS 2 Kilted answer each other, which
// every participant is sent.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming)
struct ddsi_domaingv;
struct ddsi_serdata;
GRIDMERGE_EXPORT void ddsi_tl_handle_request(ddsi_domaingv* domain, ddsi_serdata* request);
GRIDMERGE_EXPORT void ddsi_tl_handle_reply(ddsi_domaingv* domain, ddsi_serdata* reply);
// NOLINTEND(readability-identifier-naming)

void ddsi_tl_handle_request(ddsi_domaingv* /*domain*/, ddsi_serdata* /*request*/) {}
void ddsi_tl_handle_reply(ddsi_domaingv* /*domain*/, ddsi_serdata* /*reply*/) {}
}

namespace gridmerge::internal {

namespace {

/// A plugin of Cyclone DDS, by the names of its library and of two functions in it.
struct Plugin {
  const char* property;
  const char* library;
  const char* init;
  const char* finalize;
};

constexpr std::array kPlugins{
    Plugin{"dds.sec.auth", "dds_security_auth", "init_authentication", "finalize_authentication"},
    Plugin{"dds.sec.access", "dds_security_ac", "init_access_control", "finalize_access_control"},
    Plugin{"dds.sec.crypto", "dds_security_crypto", "init_crypto", "finalize_crypto"}};

}  // namespace

QosPtr participant_qos(const RosEnvironment& environment) {
  QosPtr qos(dds_create_qos());
  // Without it ROS takes this for no node of its own.
  const std::string user_data = fmt::format("enclave={};", environment.enclave);
  dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  if (environment.enclave_files.empty()) return qos;
  const auto set = [&](const std::string& name, const std::string& value) {
    dds_qset_prop(qos.get(), name.c_str(), value.c_str());
  };
  for (const Plugin& plugin : kPlugins) {
    const std::string library = std::string(plugin.property) + ".library.";
    set(library + "path", plugin.library);
    set(library + "init", plugin.init);
    set(library + "finalize", plugin.finalize);
  }
  const auto set_file = [&](const EnclaveFile& file) {
    set(file.property, "file:" + (environment.enclave_files / file.name).string());
  };
  for (const EnclaveFile& file : kEnclaveFiles) set_file(file);
  if (std::filesystem::exists(environment.enclave_files / kRevokedCertificates.name))
    set_file(kRevokedCertificates);
  return qos;
}

/// Takes what Cyclone DDS logs, from any thread.
class Participant::Log {
 public:
  Log() { dds_set_log_sink(&Log::write, this); }
  ~Log() { dds_set_log_sink(nullptr, nullptr); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  std::vector<LogLine> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(lines_, {});
  }

  std::uint64_t undecodable() const { return undecodable_; }

 private:
  static void write(void* log, const dds_log_data_t* data) { static_cast<Log*>(log)->add(*data); }

  void add(const dds_log_data_t& data) {
    if ((data.priority & (DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING)) == 0) return;
    std::string_view text = data.message;
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
    // Any peer can send such messages, as many as it likes: they are counted.
    if (text.find("deserialization") != std::string_view::npos) {
      ++undecodable_;
      return;
    }
    // Of these too, so that they are put together here: the node looks only now and then.
    LogLine line{{}, std::string(text)};
    line.kind = kind_of_line(line.text);
    const std::lock_guard lock(mutex_);
    const auto find = [&] {
      return std::find_if(lines_.begin(), lines_.end(),
                          [&](const LogLine& other) { return other.kind == line.kind; });
    };
    auto like_it = find();
    if (like_it == lines_.end() && lines_.size() + 1 >= kMaxLogLines) {
      line.kind.clear();  // the last line is that of all further kinds
      like_it = find();
    }
    if (like_it != lines_.end())
      ++like_it->count;
    else
      lines_.push_back(std::move(line));
  }

  std::mutex mutex_;
  std::vector<LogLine> lines_;
  std::atomic<std::uint64_t> undecodable_{0};
};

Participant::Participant(const RosEnvironment& environment, std::uint64_t largest_message,
                         const NetworkAddresses& network)
    : log_(std::make_unique<Log>()) {
  try {
    domain_ = DdsEntity(
        dds_create_domain(environment.domain,
                          cyclone_configuration(environment, largest_message, !network.empty()).c_str()),
        fmt::format("domain {}", environment.domain));
    const QosPtr qos = participant_qos(environment);
    participant_ = DdsEntity(dds_create_participant(environment.domain, qos.get(), nullptr),
                             fmt::format("a participant of domain {}", environment.domain));
    require_dds(dds_get_guid(participant_.get(), &guid_), "the participant's number");
  } catch (const std::runtime_error& error) {
    std::string message = error.what();
    for (const LogLine& line : log_->take()) message += "; " + line.text;
    throw std::runtime_error(message);
  }
}

Participant::~Participant() {
  participant_.reset();
  domain_.reset();
}

std::vector<Participant::LogLine> Participant::take_log() {
  return log_->take();
}

std::uint64_t Participant::undecodable() const {
  return log_->undecodable();
}

}  // namespace gridmerge::internal
