// What people may do to the network of a simulated robot that is behind one.
#include "sim/panel_table.hpp"

namespace meca::sim {
namespace {

using Form = Number::Form;

NetworkAddress address_of(double number) noexcept {
  const auto bits = static_cast<std::uint64_t>(number);
  return {static_cast<std::uint32_t>(bits >> 16), static_cast<std::uint16_t>(bits & 0xFFFF)};
}

// A row whose word only sets something, and says so.
using Apply = void (*)(NetworkFaults&, const PanelRequest&, PanelAnswer&) noexcept;
constexpr Row network(std::string_view words, std::span<const Number> numbers, std::string_view about, Apply apply) {
  return {words, numbers, about, nullptr, nullptr, apply};
}

constexpr Number kLate[] = {{"MS", 0, 60'000}};
constexpr Number kStatus[] = {{"STATUS", 1, 65535, Form::kCode}};
// 3: the sequence count and a byte; 511: what the nine bits of a Forward Open's size hold.
constexpr Number kSize[] = {{"SIZE", 3, 511, Form::kWhole}};
constexpr Number kInterval[] = {{"US", 1'000, 10'000'000, Form::kWhole}};
constexpr Number kAddress[] = {{"A.B.C.D:PORT", 0, 0, Form::kAddress}};

constexpr Row kRows[] = {
    network("unplug", {}, "the cable is out: nothing goes in or out until 'plug'",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.unplugged = true;
              done(answer, "the cable is out");
            }),
    network("plug", {}, "puts it back",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.unplugged = false;
              done(answer, "the cable is in");
            }),
    network("freeze", {}, "answers explicit messages but handles no I/O, until 'thaw'",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.frozen = true;
              done(answer, "no I/O is handled");
            }),
    network("thaw", {}, "handles I/O again",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.frozen = false;
              done(answer, "I/O is handled");
            }),
    network("late", kLate, "explicit messages are answered so much later; 0 ends it",
            [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
              f.late = std::chrono::duration_cast<Time>(std::chrono::duration<double, std::milli>(r.numbers[0]));
              done(answer, f.late > Time::zero() ? "answers are late" : "answers come at once");
            }),
    network("refuse open", kStatus, "every Forward Open, with this extended status, e.g. 0x0106",
            [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
              f.refuse_open = static_cast<std::uint16_t>(r.numbers[0]);
              done(answer, "connections are refused");
            }),
    network("wrong size", kSize, "only this T->O size opens a connection, instead of 254",
            [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
              f.wrong_size = static_cast<std::uint16_t>(r.numbers[0]);
              done(answer, "connections of that T->O size are accepted, no others");
            }),
    network("api", kInterval, "this packet interval for new connections, whatever RPI is asked",
            [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
              f.api_us = static_cast<std::uint32_t>(r.numbers[0]);
              done(answer, "new connections get this interval");
            }),
    network("no socket items", {}, "Forward Open replies do not say where to send",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.no_socket_items = true;
              done(answer, "replies have no socket address items");
            }),
    network("foreign address", kAddress, "Forward Open replies name this address, e.g. 192.0.2.9:2222",
            [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
              f.foreign_address = address_of(r.numbers[0]);
              done(answer, "replies name a foreign address");
            }),
    network("stop producing", {}, "the connection stays open, T->O packets end",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.stop_producing = true;
              done(answer, "no T->O packets");
            }),
    network("duplicate", {}, "every T->O packet twice",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.duplicate = true;
              done(answer, "every T->O packet comes twice");
            }),
    network("stale sequence", {}, "every second T->O packet has an old sequence number",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.stale_sequence = true;
              done(answer, "every second T->O packet is stale");
            }),
    network("corrupt", {}, "T->O packets of a wrong length",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.corrupt = true;
              done(answer, "T->O packets are too short");
            }),
    network("frozen count", {}, "T->O packets say they have no new data",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              f.frozen_count = true;
              done(answer, "the sequence count stands still");
            }),
    network("close tcp", {}, "hangs up all TCP connections, once; I/O goes on",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              ++f.tcp_closures;
              done(answer, "TCP connections are closed");
            }),
    network("faults off", {}, "ends everything that is wrong with the network; buttons and errors stay",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              const std::uint64_t closures = f.tcp_closures;
              f = {};
              f.tcp_closures = closures;
              done(answer, "the network is healthy");
            }),
    network("faults", {}, "what is wrong with the network now",
            [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
              answer.kind = PanelAnswer::Kind::kFaults;
              answer.faults = f;
            }),
};

}  // namespace

std::span<const Row> network_rows() noexcept { return kRows; }

}  // namespace meca::sim
