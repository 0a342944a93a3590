// What people may do to the network of a simulated robot on EtherNet/IP.
#include "sim/panel_table.hpp"

namespace meca::sim {
namespace {

using Form = Number::Form;

NetworkAddress address_of(double number) noexcept {
  const auto bits = static_cast<std::uint64_t>(number);
  return {static_cast<std::uint32_t>(bits >> 16), static_cast<std::uint16_t>(bits & 0xFFFF)};
}

constexpr Number kStatus[] = {{"STATUS", 1, 65535, Form::kCode}};
// 3: the sequence count and a byte; 511: what the nine bits of a Forward Open's size hold.
constexpr Number kSize[] = {{"SIZE", 3, 511, Form::kWhole}};
constexpr Number kInterval[] = {{"US", 1'000, 10'000'000, Form::kWhole}};
constexpr Number kAddress[] = {{"A.B.C.D:PORT", 0, 0, Form::kAddress}};

constexpr Row kRows[] = {
    network_row("refuse open", kStatus, "every Forward Open, with this extended status, e.g. 0x0106",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.refuse_open = static_cast<std::uint16_t>(r.numbers[0]);
                  done(answer, "connections are refused");
                }),
    network_row("wrong size", kSize, "only this T->O size opens a connection, instead of 254",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.wrong_size = static_cast<std::uint16_t>(r.numbers[0]);
                  done(answer, "connections of that T->O size are accepted, no others");
                }),
    network_row("api", kInterval, "this packet interval for new connections, whatever RPI is asked",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.api_us = static_cast<std::uint32_t>(r.numbers[0]);
                  done(answer, "new connections get this interval");
                }),
    network_row("no socket items", {}, "Forward Open replies do not say where to send",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.no_socket_items = true;
                  done(answer, "replies have no socket address items");
                }),
    network_row("foreign address", kAddress, "Forward Open replies name this address, e.g. 192.0.2.9:2222",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.foreign_address = address_of(r.numbers[0]);
                  done(answer, "replies name a foreign address");
                }),
    network_row("stop producing", {}, "the connection stays open, T->O packets end",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.stop_producing = true;
                  done(answer, "no T->O packets");
                }),
    network_row("stale sequence", {}, "every second T->O packet has an old sequence number",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.stale_sequence = true;
                  done(answer, "every second T->O packet is stale");
                }),
    network_row("frozen count", {}, "T->O packets say they have no new data",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.frozen_count = true;
                  done(answer, "the sequence count stands still");
                }),
    network_row("close tcp", {}, "hangs up all TCP connections, once; I/O goes on",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  ++f.events.tcp_closures;
                  done(answer, "TCP connections are closed");
                }),
};

}  // namespace

std::span<const Row> ethernet_ip_rows() noexcept { return kRows; }

}  // namespace meca::sim
