// SPDX-License-Identifier: Apache-2.0
#include "keystore.hpp"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace gridmerge::test {

namespace {

constexpr const char* kGovernance = R"(<?xml version="1.0" encoding="UTF-8"?>
<dds><domain_access_rules><domain_rule>
  <domains><id_range><min>0</min><max>230</max></id_range></domains>
  <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
  <enable_join_access_control>true</enable_join_access_control>
  <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
  <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
  <rtps_protection_kind>SIGN</rtps_protection_kind>
  <topic_access_rules><topic_rule>
    <topic_expression>*</topic_expression>
    <enable_discovery_protection>true</enable_discovery_protection>
    <enable_liveliness_protection>true</enable_liveliness_protection>
    <enable_read_access_control>true</enable_read_access_control>
    <enable_write_access_control>true</enable_write_access_control>
    <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
    <data_protection_kind>ENCRYPT</data_protection_kind>
  </topic_rule></topic_access_rules>
</domain_rule></domain_access_rules></dds>
)";

std::string permissions_of(const std::string& enclave) {
  const std::string all = "<topics><topic>*</topic></topics>";
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds><permissions><grant name=")" +
         enclave + R"(">
  <subject_name>CN=)" +
         enclave + R"(</subject_name>
  <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2099-01-01T00:00:00</not_after></validity>
  <allow_rule>
    <domains><id_range><min>0</min><max>230</max></id_range></domains>
    <publish>)" +
         all + "</publish><subscribe>" + all + R"(</subscribe>
  </allow_rule>
  <default>DENY</default>
</grant></permissions></dds>
)";
}

/// For openssl, to which a slash begins another part of a name.
std::string subject_of(const std::string& enclave) {
  std::string subject;
  for (const char c : enclave) subject += c == '/' ? std::string("\\/") : std::string(1, c);
  return "'/CN=" + subject + "'";
}

}  // namespace

bool Keystore::can_be_made() {
  return std::system("openssl version > /dev/null 2>&1") == 0;
}

Keystore::Keystore() {
  directory_.write("governance.xml", kGovernance);
  run("ecparam -name prime256v1 -genkey -noout -out ca.key");
  run("req -x509 -new -key ca.key -sha256 -days 30 -subj /CN=authority -out ca.pem");
  run("smime -sign -text -in governance.xml -out governance.p7s -signer ca.pem -inkey ca.key");
}

void Keystore::add(const std::string& enclave) const {
  const std::string folder = "enclaves" + enclave + "/";
  directory_.write(folder + "permissions.xml", permissions_of(enclave));
  for (const char* authority : {"identity_ca.cert.pem", "permissions_ca.cert.pem"})
    std::filesystem::copy_file(directory_.file("ca.pem"), directory_.file(folder + authority));
  std::filesystem::copy_file(directory_.file("governance.p7s"), directory_.file(folder + "governance.p7s"));
  run("ecparam -name prime256v1 -genkey -noout -out " + folder + "key.pem");
  run("req -new -key " + folder + "key.pem -subj " + subject_of(enclave) + " -out request.pem");
  run("x509 -req -in request.pem -CA ca.pem -CAkey ca.key -CAcreateserial -days 30 -sha256 -out " + folder +
      "cert.pem");
  run("smime -sign -text -in " + folder + "permissions.xml -out " + folder +
      "permissions.p7s -signer ca.pem -inkey ca.key");
}

void Keystore::run(const std::string& arguments) const {
  const std::string command = "cd " + path() + " && openssl " + arguments + " > openssl.log 2>&1";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error(arguments + ": " + read_file(directory_.file("openssl.log")));
}

}  // namespace gridmerge::test
