#include "transports/ethernet_ip/status_text.hpp"

#include <algorithm>
#include <functional>

namespace meca::ethernet_ip {
namespace {

constexpr std::string_view kReport = "report this: the bridge asks for something it should not";

constexpr StatusText kGeneral[] = {
    {0x00, Concern::kNothing, "done", ""},
    {0x01, Concern::kNothing, "the robot could not make the connection and does not say why",
     "restart its EtherNet/IP"},
    {0x02, Concern::kNothing, "the robot has no resources left for this",
     "close other EtherNet/IP clients of it, or restart it"},
    {0x03, Concern::kNothing, "the robot finds a parameter invalid", kReport},
    {0x04, Concern::kPath, "the robot does not understand the path", "check that the device is a Meca500"},
    {0x05, Concern::kPath, "the robot has no object or instance of this path", "check that the device is a Meca500"},
    {0x08, Concern::kNothing, "the robot does not offer this service", "check that the device is a Meca500"},
    {0x0E, Concern::kNothing, "the attribute can only be read", kReport},
    {0x13, Concern::kNothing, "the robot finds the request too short", kReport},
    {0x14, Concern::kNothing, "the robot does not have this attribute", "check that the device is a Meca500"},
    {0x15, Concern::kNothing, "the robot finds the request too long", kReport},
    {0xFF, Concern::kNothing, "an error of the vendor's own", "look into the robot's log"},
};

constexpr StatusText kExtended[] = {
    {0x0100, Concern::kTriad, "the robot still has this very connection open", "it is closed first, then opened again"},
    {0x0103, Concern::kNothing, "the robot does not know this transport class or trigger", kReport},
    {0x0106, Concern::kNothing, "another controller owns the robot's outputs",
     "stop it; if it has vanished, let it return and close, or restart EtherNet/IP on the robot"},
    {0x0107, Concern::kNothing, "the robot has no such connection", "nothing: it was closed or timed out before"},
    {0x0109, Concern::kNothing, "a connection size is wrong, the robot does not say which", "check the firmware"},
    {0x0110, Concern::kNothing, "the robot is not configured or not ready", "wait, or look at it in the MecaPortal"},
    {0x0111, Concern::kRpi, "not supported", "the Meca500 takes 10 ms to 10 s"},
    {0x0112, Concern::kRpi, "not acceptable", "with multicast, take the interval in use"},
    {0x0113, Concern::kNothing, "the robot has no connection left", "close other EtherNet/IP clients of it"},
    {0x0114, Concern::kKey, "vendor or product code differs", "check the address: this is another device"},
    {0x0115, Concern::kKey, "the device type differs", "check the address: this is another device"},
    {0x0116, Concern::kKey, "the revision does not fit", "correct the key's revision, or set the key to none"},
    {0x0117, Concern::kPath, "the robot cannot produce or consume at these points", "check that it is a Meca500"},
    {0x0118, Concern::kPath, "the robot does not take the configuration in the path", "check that it is a Meca500"},
    {0x0119, Concern::kNothing, "no controller has the outputs, and to listen one must", "start the owner first"},
    {0x011A, Concern::kNothing, "the robot has no object left for a connection", "close other clients of it"},
    {0x011B, Concern::kRpi, "faster than the robot can deliver to all its clients", "ask for a longer interval"},
    {0x011C, Concern::kNothing, "the robot does not support this transport class", kReport},
    {0x011D, Concern::kNothing, "the robot does not support this production trigger", kReport},
    {0x011E, Concern::kNothing, "the robot does not support this direction", kReport},
    {0x011F, Concern::kOToTType, "the robot wants the other of fixed and variable size O->T", "check the firmware"},
    {0x0120, Concern::kTToOType, "the robot wants the other of fixed and variable size T->O", "check the firmware"},
    {0x0121, Concern::kNothing, "the robot does not support this priority O->T", kReport},
    {0x0122, Concern::kNothing, "the robot does not support this priority T->O", kReport},
    {0x0123, Concern::kOToTType, "the robot does not support this connection type", kReport},
    {0x0124, Concern::kTToOType, "the robot does not support this connection type", "ask for the other one"},
    {0x0125, Concern::kNothing, "the robot does not support a redundant owner", kReport},
    {0x0126, Concern::kPath, "the size of the configuration is wrong", "check that the device is a Meca500"},
    {0x0127, Concern::kOToTSize, "outputs of another size", "check that it is a Meca500, and its firmware"},
    {0x0128, Concern::kTToOSize, "inputs of another size", "check that it is a Meca500, and its firmware"},
    {0x0129, Concern::kPath, "the robot does not know the configuration point", "check that it is a Meca500"},
    {0x012A, Concern::kPath, "the robot does not know the O->T point", "check that it is a Meca500"},
    {0x012B, Concern::kPath, "the robot does not know the T->O point", "check that it is a Meca500"},
    {0x012F, Concern::kPath, "the robot does not combine these points", "check that they are right, not swapped"},
    {0x0132, Concern::kNothing, "the robot does not support a null Forward Open", kReport},
    {0x0133, Concern::kMultiplier, "the robot does not take this time-out multiplier", "choose x4 to x512"},
    {0x0203, Concern::kNothing, "the connection has timed out", "no refusal: check network, load and firewall"},
    {0x0204, Concern::kNothing, "the request timed out on its way", "check network, routers and firewall"},
    {0x0205, Concern::kNothing, "a parameter of the unconnected request is wrong", kReport},
    {0x0301, Concern::kNothing, "the robot has no buffer memory left", "close other clients of it, or restart it"},
    {0x0302, Concern::kRpi, "the network has no bandwidth left for it", "ask for a longer interval"},
    {0x0311, Concern::kPath, "the path leads through a port that is not there", "check the address"},
    {0x0312, Concern::kPath, "the path holds a link address that is not valid", "check the address"},
    {0x0315, Concern::kPath, "the robot does not take a segment of the path", "check that it is a Meca500"},
    {0x0316, Concern::kPath, "the path of the close is not the one of the open", kReport},
    {0x0813, Concern::kNothing, "the robot refuses multicast beyond its subnet",
     "ask for point-to-point, or move this host into the robot's subnet"},
};

// Sorted tables can be searched, and a code that stands twice is an error here instead of a surprise.
constexpr bool ascending(std::span<const StatusText> table) {
  return std::ranges::adjacent_find(table, std::ranges::greater_equal{}, &StatusText::code) == table.end();
}
static_assert(ascending(kGeneral) && ascending(kExtended));

const StatusText* find(std::span<const StatusText> table, std::uint16_t code) noexcept {
  const auto found = std::ranges::lower_bound(table, code, {}, &StatusText::code);
  return found != table.end() && found->code == code ? &*found : nullptr;
}

using Clause = FixedText<95>;

double milliseconds(std::uint32_t us) noexcept { return us / 1000.0; }

std::uint32_t long_word(const Reply& reply, std::size_t at) noexcept {
  return reply.extended[at] | static_cast<std::uint32_t>(reply.extended[at + 1]) << 16;
}

Clause asked_rpi(const Reply& reply, const ForwardOpen& asked) noexcept {
  const double out = milliseconds(asked.o_to_t_rpi_us), in = milliseconds(asked.t_to_o_rpi_us);
  // 0x0112: types of the two values in the second word, then the values (as public dissectors read it).
  if (reply.extended[0] == 0x0112 && reply.extended_count >= 6) {
    return Clause::format("RPI %.10g/%.10g ms asked, the robot takes %.10g/%.10g", out, in,
                          milliseconds(long_word(reply, 2)), milliseconds(long_word(reply, 4)));
  }
  return Clause::format("RPI %.10g ms O->T, %.10g ms T->O asked", out, in);
}

Clause asked_size(const char* direction, unsigned size, const Reply& reply) noexcept {
  if (reply.extended_count < 2) return Clause::format("%s size %u asked", direction, size);
  return Clause::format("%s size %u asked, the robot expects %u", direction, size, unsigned{reply.extended[1]});
}

Clause asked_type(const char* direction, const NetworkParameters& p) noexcept {
  constexpr const char* kNames[] = {"null", "multicast", "point-to-point", "reserved type"};
  return Clause::format("%s %s %s asked", direction, p.variable_size ? "variable" : "fixed",
                        kNames[static_cast<std::size_t>(p.type)]);
}

Clause asked_key(const Path& path, const std::optional<Identity>& robot) noexcept {
  if (!path.key) return Clause("no key asked");
  const ElectronicKey& k = *path.key;
  const char* policy = k.compatible ? "compatible with" : "exactly";
  if (!robot) return Clause::format("key %s %u.%u asked", policy, unsigned{k.major}, unsigned{k.minor});
  return Clause::format("key %s %u.%u asked, the robot is %u.%u", policy, unsigned{k.major}, unsigned{k.minor},
                        unsigned{robot->major}, unsigned{robot->minor});
}

Clause asked_points(const Path& path) noexcept {
  if (path.connection_point_count != 2) return Clause("a path without two points asked");
  return Clause::format("points O->T %u, T->O %u asked", static_cast<unsigned>(path.connection_points[0]),
                        static_cast<unsigned>(path.connection_points[1]));
}

// "RPI 5 ms O->T, 5 ms T->O asked": what the status is about, of what was asked.
Clause asked_clause(Concern concern, const Reply& reply, const ForwardOpen& asked,
                    const std::optional<Identity>& robot) noexcept {
  Path path;
  read_path(asked.path, path);
  switch (concern) {
    case Concern::kNothing:
      return {};
    case Concern::kRpi:
      return asked_rpi(reply, asked);
    case Concern::kMultiplier:
      return Clause::format("multiplier code %u asked", unsigned{asked.multiplier_code});
    case Concern::kOToTSize:
      return asked_size("O->T", asked.o_to_t.size, reply);
    case Concern::kTToOSize:
      return asked_size("T->O", asked.t_to_o.size, reply);
    case Concern::kOToTType:
      return asked_type("O->T", asked.o_to_t);
    case Concern::kTToOType:
      return asked_type("T->O", asked.t_to_o);
    case Concern::kKey:
      return asked_key(path, robot);
    case Concern::kPath:
      return asked_points(path);
    case Concern::kTriad:
      return Clause::format("serial 0x%04X asked", unsigned{asked.triad.connection_serial});
  }
  return {};
}

// "0x01", "0x01/0x0106", "0x01/0x0127 0x0042".
FixedText<20> codes(const Reply& reply) noexcept {
  const unsigned general = reply.general, first = reply.extended[0], second = reply.extended[1];
  if (reply.extended_count == 0) return FixedText<20>::format("0x%02X", general);
  if (reply.extended_count == 1) return FixedText<20>::format("0x%02X/0x%04X", general, first);
  return FixedText<20>::format("0x%02X/0x%04X 0x%04X", general, first, second);
}

}  // namespace

std::span<const StatusText> general_status_texts() noexcept { return kGeneral; }
std::span<const StatusText> extended_status_texts() noexcept { return kExtended; }
const StatusText* find_general_status(std::uint8_t general) noexcept { return find(kGeneral, general); }
const StatusText* find_extended_status(std::uint16_t extended) noexcept { return find(kExtended, extended); }

RefusalText refusal_text(std::string_view request, const Reply& reply, const ForwardOpen* asked,
                         const std::optional<Identity>& robot) noexcept {
  constexpr StatusText kUnnamed{0, Concern::kNothing, "a status that no document names", "look into the robot's log"};
  const bool detailed =
      reply.general == static_cast<std::uint8_t>(GeneralStatus::kConnectionFailure) && reply.extended_count > 0;
  const StatusText* found = detailed ? find_extended_status(reply.extended[0]) : find_general_status(reply.general);
  const StatusText& text = found != nullptr ? *found : kUnnamed;
  const Clause clause = asked != nullptr ? asked_clause(text.concern, reply, *asked, robot) : Clause{};
  const auto in_hex = codes(reply);
  const auto length = [](std::string_view s) { return static_cast<int>(s.size()); };
  return RefusalText::format("%.*s refused (%.*s): %.*s%s%.*s%s%.*s", length(request), request.data(), length(in_hex),
                             in_hex.view().data(), length(clause), clause.view().data(), clause.empty() ? "" : "; ",
                             length(text.meaning), text.meaning.data(), text.remedy.empty() ? "" : "; ",
                             length(text.remedy), text.remedy.data());
}

FixedText<15> dotted(std::uint32_t ipv4) noexcept {
  return FixedText<15>::format("%u.%u.%u.%u", unsigned{ipv4 >> 24}, unsigned{ipv4 >> 16 & 0xFF},
                               unsigned{ipv4 >> 8 & 0xFF}, unsigned{ipv4 & 0xFF});
}

}  // namespace meca::ethernet_ip
