// Every key the configuration knows, once: the reader refuses what is not here, config/reference.yaml must name each.
#pragma once

#include <array>
#include <string_view>

namespace meca::bridge::config_keys {

struct Key {
  std::string_view section;  // where it stands: "", "dds", "dds.topics.*" (* = a topic), "robots[]" ([] = each element)
  std::string_view name;
  std::string_view transport_type = {};  // in "robots[].transport": the only type that has it; empty = all of them
};

inline constexpr std::array kKeys{
    Key{"", "dds"},
    Key{"", "log"},
    Key{"", "realtime"},
    Key{"", "ethernet_ip"},
    Key{"", "ethercat"},
    Key{"", "robots"},
    Key{"dds", "domain"},
    Key{"dds", "participant_name"},
    Key{"dds", "topic_prefix"},
    Key{"dds", "interfaces"},
    Key{"dds", "shared_memory"},
    Key{"dds", "topics"},
    Key{"dds.topics.*", "rate"},
    Key{"dds.topics.*", "reliability"},
    Key{"dds.topics.*", "durability"},
    Key{"dds.topics.*", "depth"},
    Key{"log", "level"},
    Key{"realtime", "priority"},
    Key{"realtime", "lock_memory"},
    Key{"realtime", "cpus"},
    Key{"ethernet_ip", "bind"},
    Key{"ethernet_ip", "io_port"},
    Key{"ethernet_ip", "vendor_id"},
    Key{"ethernet_ip", "serial_number"},
    Key{"ethercat", "segments"},
    Key{"ethercat.segments[]", "interface"},
    Key{"ethercat.segments[]", "redundant_interface"},
    Key{"ethercat.segments[]", "dc"},
    Key{"ethercat.segments[]", "dc_shift"},
    Key{"ethercat.segments[]", "watchdog"},
    Key{"ethercat.segments[]", "separate"},
    Key{"robots[]", "name"},
    Key{"robots[]", "transport"},
    Key{"robots[]", "cycle"},
    Key{"robots[]", "firmware"},
    Key{"robots[]", "dynamic_data"},
    Key{"robots[]", "control"},
    Key{"robots[].transport", "type"},
    Key{"robots[].transport", "product", "builtin"},
    Key{"robots[].transport", "firmware", "builtin"},
    Key{"robots[].transport", "serial_number", "builtin"},
    Key{"robots[].transport", "instant_homing", "builtin"},
    Key{"robots[].transport", "noise", "builtin"},
    Key{"robots[].transport", "tool", "builtin"},
    Key{"robots[].transport", "control_socket", "builtin"},
    Key{"robots[].transport", "address", "ethernet_ip"},
    Key{"robots[].transport", "tcp_port", "ethernet_ip"},
    Key{"robots[].transport", "rpi", "ethernet_ip"},
    Key{"robots[].transport", "timeout_multiplier", "ethernet_ip"},
    Key{"robots[].transport", "multicast", "ethernet_ip"},
    Key{"robots[].transport", "key", "ethernet_ip"},
    Key{"robots[].transport", "key_revision", "ethernet_ip"},
    Key{"robots[].transport", "large_forward_open", "ethernet_ip"},
    Key{"robots[].transport", "fast", "ethernet_ip"},
    Key{"robots[].transport", "interface", "ethercat"},
    Key{"robots[].transport", "position", "ethercat"},
    Key{"robots[].transport", "alias", "ethercat"},
    Key{"robots[].transport", "interface", "profinet"},
    Key{"robots[].transport", "station_name", "profinet"},
    Key{"robots[].transport", "byte_order", "profinet"},
    Key{"robots[].control", "enabled"},
    Key{"robots[].control", "lease"},
    Key{"robots[].control", "velocity_lease"},
    Key{"robots[].control", "allow_brakes"},
    Key{"robots[].control", "on_loss"},
    Key{"robots[].control", "take_over_grace"},
    Key{"robots[].control", "clients"},
    Key{"robots[].control.clients[]", "name"},
    Key{"robots[].control.clients[]", "priority"},
    Key{"robots[].control.clients[]", "on_loss"},
};

}  // namespace meca::bridge::config_keys
