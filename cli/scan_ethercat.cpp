#include "cli/scan_ethercat.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/format.hpp"
#include "transports/ethercat/al_status.hpp"

namespace meca::cli {
namespace {

using ethercat::DcSupport;
using ethercat::ScannedDevice;
using ethercat::ScannedPort;

template <class... Arguments>
std::string print(const char* format, Arguments... arguments) {
  char text[128];
  std::snprintf(text, sizeof text, format, arguments...);
  return text;
}

bool is_known_meca500(const ScannedDevice& d) { return d.identity && ethercat::is_meca500(*d.identity); }
// Who it is cannot be read while a master works with it; how its process data lies can.
bool looks_like_meca500(const ScannedDevice& d) { return !d.identity && d.process_data_of_meca500; }
bool has_error(const ScannedDevice& d) { return (d.al_status & ethercat::kAlError) != 0; }
std::string at(const ScannedDevice& d) { return "position " + std::to_string(d.position); }

std::string name_of(const ScannedDevice& d) {
  if (is_known_meca500(d)) return "Meca500";
  return looks_like_meca500(d) ? "Meca500?" : "-";
}

std::string state_of(const ScannedDevice& d) {
  return std::string(ethercat::al_state_name(d.al_status)) + (has_error(d) ? " + error" : "");
}

std::string links_of(const ScannedDevice& d) {
  std::string list;
  for (std::size_t p = 0; p < d.ports.size(); ++p) {
    if (d.ports[p].link) list += (list.empty() ? "" : " ") + std::to_string(p);
  }
  return list.empty() ? "none" : list;
}

unsigned errors_of(const ScannedDevice& d) {
  unsigned sum = d.processing_errors + d.pdi_errors;
  for (const ScannedPort& p : d.ports) sum += p.invalid_frames + p.rx_errors + p.forwarded_errors + p.lost_links;
  return sum;
}

std::string dc_of(const ScannedDevice& d) {
  switch (d.dc) {
    case DcSupport::kNone:
      return "no";
    case DcSupport::k32Bit:
      return "32 bit";
    case DcSupport::k64Bit:
      return "64 bit";
  }
  return "";
}

std::vector<std::string> row_of(const ScannedDevice& d) {
  std::vector<std::string> row{std::to_string(d.position)};
  if (!d.answered) {
    row.push_back("does not answer");
    return row;
  }
  row.push_back(d.station_address == 0 ? "-" : print("0x%04x", d.station_address));
  row.push_back(d.alias == 0 ? "-" : std::to_string(d.alias));
  row.push_back(name_of(d));
  if (d.identity) {
    for (const auto number : {d.identity->vendor, d.identity->product, d.identity->revision}) {
      row.push_back(print("0x%08x", number));
    }
    row.push_back(std::to_string(d.identity->serial));
  } else {
    row.insert(row.end(), 4, "-");
  }
  row.insert(row.end(), {state_of(d), links_of(d), std::to_string(errors_of(d)), dc_of(d)});
  return row;
}

// "3 invalid frames"; nothing for none. The counters stop at 255.
void count(std::string& list, unsigned number, const char* one, const char* many) {
  if (number == 0) return;
  list += (list.empty() ? "" : ", ") + std::to_string(number) + (number == 255 ? " or more " : " ") +
          (number == 1 ? one : many);
}

std::string counters_in_words(const ScannedDevice& d) {
  std::string text;
  for (std::size_t p = 0; p < d.ports.size(); ++p) {
    const ScannedPort& port = d.ports[p];
    std::string list;
    count(list, port.invalid_frames, "invalid frame", "invalid frames");
    count(list, port.rx_errors, "receive error", "receive errors");
    count(list, port.forwarded_errors, "forwarded error", "forwarded errors");
    count(list, port.lost_links, "lost link", "lost links");
    if (!list.empty()) text += at(d) + ", port " + std::to_string(p) + ": " + list + "\n";
  }
  std::string list;
  count(list, d.processing_errors, "frame it could not process", "frames it could not process");
  count(list, d.pdi_errors, "error of its own processor's interface", "errors of its own processor's interface");
  if (!list.empty()) text += at(d) + ": " + list + "\n";
  return text;
}

std::string remarks_on(const ScannedDevice& d) {
  std::string text;
  if (!d.answered) {
    return at(d) + " was counted and does not answer alone; scan again, and look for other masters and loose cables\n";
  }
  if (has_error(d)) {
    text += at(d) + ": " + std::string(ethercat::al_state_name(d.al_status)) + " with AL status code " +
            print("0x%04x", d.al_code) + ": " + std::string(ethercat::al_code_text(d.al_code)) + "\n";
  }
  if (!d.identity) {
    text += at(d) + ": who it is was not read: " + std::string(d.identity_trouble.view()) +
            (d.process_data_of_meca500 ? "; its process data is laid out as that of a Meca500" : "") + "\n";
  } else if (!d.identity->checksum_right) {
    text += at(d) + ": the checksum of its SII is wrong, the numbers from it may be wrong too\n";
  } else if (d.identity->alias != d.alias) {
    text += at(d) + ": its SII says alias " + std::to_string(d.identity->alias) + ", it uses " +
            std::to_string(d.alias) + " until its power is switched off and on\n";
  }
  return text + counters_in_words(d);
}

// Highest state that any device keeps only while a master sends process data.
std::string remarks_on(const ScannedChain& chain) {
  std::string text;
  const auto running = std::ranges::find_if(chain.devices, ethercat::runs_under_a_master);
  if (running != chain.devices.end()) {
    text += at(*running) + " is in " + std::string(ethercat::al_state_name(running->al_status)) +
            ": a master runs this chain; a second one (a bridge, a PLC) would disturb it\n";
  } else if (chain.frames_of_others) {
    text += "frames of another master pass on " + chain.interface + "\n";
  }
  if (!chain.ring_end.empty()) {
    text += "frames sent on " + chain.interface + " come back on " + chain.ring_end + ": the cables make a ring\n";
  }
  return text;
}

}  // namespace

std::string chain_text(const ScannedChain& chain) {
  std::vector<std::vector<std::string>> rows{{"POSITION", "ADDRESS", "ALIAS", "NAME", "VENDOR", "PRODUCT", "REVISION",
                                              "SERIAL", "STATE", "LINKS", "ERRORS", "DC"}};
  std::string remarks;
  for (const ScannedDevice& device : chain.devices) {
    rows.push_back(row_of(device));
    remarks += remarks_on(device);
  }
  const auto robots = std::ranges::count_if(chain.devices, is_known_meca500);
  const auto perhaps = std::ranges::count_if(chain.devices, looks_like_meca500);
  std::string found = chain.interface + ": " + std::to_string(chain.devices.size()) +
                      (chain.devices.size() == 1 ? " device" : " devices");
  if (robots > 0 || perhaps == 0) found += ", " + (robots == 0 ? "no" : std::to_string(robots)) + " Meca500";
  if (perhaps > 0) found += ", " + std::to_string(perhaps) + " perhaps a Meca500";
  return table(rows) + found + "\n" + remarks + remarks_on(chain);
}

Json to_json(const ScannedChain& chain, const ScannedDevice& d) {
  Json json{{"interface", chain.interface}, {"position", d.position}, {"answered", d.answered}};
  if (!d.answered) return json;
  json["station_address"] = d.station_address;
  json["alias"] = d.alias;
  json["meca500"] = is_known_meca500(d);
  json["process_data_of_meca500"] = d.process_data_of_meca500;
  if (d.identity) {
    json["vendor"] = d.identity->vendor;
    json["product"] = d.identity->product;
    json["revision"] = d.identity->revision;
    json["serial"] = d.identity->serial;
    json["sii_alias"] = d.identity->alias;
    json["sii_checksum_right"] = d.identity->checksum_right;
  } else {
    json["identity_trouble"] = d.identity_trouble.view();
  }
  json["al_state"] = ethercat::al_state_name(d.al_status);
  json["al_error"] = has_error(d);
  json["al_status_code"] = d.al_code;
  if (has_error(d)) json["al_status_code_text"] = ethercat::al_code_text(d.al_code);
  json["under_a_master"] = ethercat::runs_under_a_master(d);
  json["frames_of_others"] = chain.frames_of_others;
  json["dc"] = dc_of(d);
  json["ports"] = Json::array();
  for (std::size_t p = 0; p < d.ports.size(); ++p) {
    const ScannedPort& port = d.ports[p];
    if (!port.exists) continue;
    json["ports"].push_back({{"port", p},
                             {"link", port.link},
                             {"loop_closed", port.loop_closed},
                             {"communication", port.communication},
                             {"invalid_frames", port.invalid_frames},
                             {"rx_errors", port.rx_errors},
                             {"forwarded_errors", port.forwarded_errors},
                             {"lost_links", port.lost_links}});
  }
  json["processing_errors"] = d.processing_errors;
  json["pdi_errors"] = d.pdi_errors;
  return json;
}

std::string nobody_in_chain(const std::string& interface, std::chrono::nanoseconds waited, bool looped) {
  if (looped) {
    return "only our own frames come back on " + interface +
           ": there is a loop (a switch, or a cable back to this machine) and no EtherCAT device; plug the robot's "
           "cable straight into " +
           interface;
  }
  return "no EtherCAT device answered on " + interface + " within " + seconds_text(waited) +
         "; check that the robot has power and that its first Ethernet port is wired straight to " + interface +
         " (no switch, no router), that EtherCAT is enabled on it (a robot from the factory speaks TCP/IP until it is "
         "switched over), and that " +
         interface + " is the right port of this machine; in a ring name both: --interface " + interface +
         " --interface ...";
}

}  // namespace meca::cli
