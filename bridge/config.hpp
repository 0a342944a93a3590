// What the YAML configuration says, checked and complete. config_yaml.cpp is the only file that sees yaml-cpp.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridge/control/client_rules.hpp"
#include "transports/ethernet_ip/transport.hpp"
#include "transports/transport.hpp"

namespace meca::bridge {

enum class RateKind : std::uint8_t { kOff, kEveryCycle, kOnChange, kPeriod };

struct TopicConfig {
  RateKind rate = RateKind::kOnChange;
  std::chrono::nanoseconds period{};  // kPeriod
  bool reliable = true;               // writers offer RELIABLE unless told otherwise
  bool transient_local = true;        // late joiners get the last value
  int depth = 1;                      // KEEP_LAST depth per instance
};

struct DdsConfig {
  int domain = 0;  // 0..232
  std::string participant_name = "meca-bridge";
  std::string topic_prefix = "meca500/";
  std::vector<std::string> interfaces;  // IPv4 addresses; empty = all
  bool shared_memory = false;
  std::map<std::string, TopicConfig> topics;  // every published topic by its name without prefix, defaults filled in
};

struct BuiltinConfig {
  std::string product = "R4";     // R3 | R4
  std::string firmware = "11.3";  // 9.x, 10.x or 11.x: what the model behaves like
  std::uint32_t serial_number = 1;
  bool instant_homing = false;  // activation and homing without waiting
  bool noise = true;
  std::string tool = "none";            // none | MEGP25E | MEGP25LS | MPM500
  std::string control_socket = "auto";  // auto | off | a path
};
struct EthernetIpConfig {
  std::string address;  // host name or IPv4 of the robot
  std::uint16_t tcp_port = ethernet_ip::kTcpPort;
  std::chrono::nanoseconds rpi{};         // requested packet interval of both directions; never shorter than the cycle
  std::uint32_t timeout_multiplier = 16;  // 4, 8 .. 512
  bool multicast = false;                 // robot -> bridge
  ethernet_ip::KeyPolicy key = ethernet_ip::KeyPolicy::kNone;
  std::uint8_t key_major = 11, key_minor = 3;
  bool large_forward_open = false;
  bool fast = false;  // the device takes shorter intervals than the EDS of the robot allows
};
struct EthercatConfig {
  std::string interface;               // network interface of the segment
  std::uint16_t position = 0;          // position on the segment, 0 = first
  std::optional<std::uint16_t> alias;  // station alias in place of the position
};
struct ProfinetConfig {
  std::string interface;
  std::string station_name;
  bool big_endian = true;  // not published by the vendor
};

enum class TransportType : std::uint8_t { kBuiltin, kEthernetIp, kEthercat, kProfinet };

struct ControlConfig {
  bool enabled = true;                                              // false: this bridge only monitors this robot
  std::chrono::nanoseconds lease = std::chrono::milliseconds(100);  // read from a file: at least three cycles
  std::chrono::nanoseconds velocity_lease = std::chrono::milliseconds(50);  // the same
  bool allow_brakes = false;
  control::ClientRules clients;  // grace, policies and priorities
};

struct RobotConfig {
  std::string name;
  TransportType type = TransportType::kBuiltin;
  BuiltinConfig builtin;
  EthernetIpConfig ethernet_ip;
  EthercatConfig ethercat;
  ProfinetConfig profinet;
  std::chrono::nanoseconds cycle = std::chrono::milliseconds(1);
  transports::FirmwareVersion firmware{};       // all 0 = auto
  std::array<std::uint32_t, 4> dynamic_data{};  // requested types; 0 = automatic
  ControlConfig control;
};

// What all EtherNet/IP robots share.
struct EthernetIpBusConfig {
  std::string bind = "0.0.0.0";  // own IPv4 address
  std::uint16_t io_port = ethernet_ip::kIoPort;
  std::uint16_t vendor_id = ethernet_ip::kOurVendorId;
  std::uint32_t serial_number = 0;  // 0: made of this machine and this bridge
};

// What the EtherCAT robots on one network interface share.
struct EthercatSegmentConfig {
  std::string interface;
  std::string redundant_interface;  // where the ring comes back; empty: a line
  bool dc = false;
  std::chrono::nanoseconds dc_shift{};
  std::chrono::nanoseconds watchdog = std::chrono::milliseconds(100);
  bool separate = false;  // LRD and LWR in place of LRW
};

struct LogConfig {
  std::string level = "info";
};

struct RealtimeConfig {
  int priority = 0;  // SCHED_FIFO 1..99; 0 = leave it
  bool lock_memory = false;
  std::vector<int> cpus{};  // affinity of the cycle threads; empty = all
};

struct Config {
  DdsConfig dds;
  LogConfig log;
  RealtimeConfig realtime;
  EthernetIpBusConfig ethernet_ip;
  std::vector<EthercatSegmentConfig> ethercat;  // one of every interface that an EtherCAT robot names, in their order
  std::vector<RobotConfig> robots;
};

// One mistake: where, what, and what instead. line and column count from 1; 0 = the file as a whole.
struct ConfigError {
  std::string file;
  int line = 0, column = 0;
  std::string key;  // "robots[0].transport.adress"
  std::string message;
};
std::string to_string(const ConfigError& error);  // file:line:col: key: message

struct ConfigResult {
  std::optional<Config> config;       // empty when there are errors
  std::vector<ConfigError> errors;    // all of them, in file order
  std::vector<ConfigError> warnings;  // runs, but probably not as meant
};

// Neither throws: what cannot be read is an error in the result. The file may have up to 1 MiB.
ConfigResult load_config(const std::filesystem::path& file);
ConfigResult parse_config(std::string_view yaml, const std::string& file_name);

// "11", "11.3", "11.3.3.12637"; what is left out is 0. Empty for anything else.
std::optional<transports::FirmwareVersion> parse_firmware(std::string_view text);

std::string_view to_string(TransportType type);            // "builtin", "ethernet_ip", "ethercat", "profinet"
bool is_available(TransportType type);                     // this build can run it
std::string to_string(const TopicConfig& topic);           // "every 10ms, reliable, transient_local, depth 1"
std::string to_string(std::chrono::nanoseconds duration);  // "500us", "1ms", "1.5ms"

}  // namespace meca::bridge
