// What people may do to the network of a simulated robot on EtherCAT.
#include "sim/panel_table.hpp"

namespace meca::sim {
namespace {

using Form = Number::Form;

constexpr Number kHowMany[] = {{"N", 1, 1'000'000, Form::kWhole}};
constexpr Number kEvery[] = {{"N", 0, 1'000'000, Form::kWhole}};
constexpr Number kAdded[] = {{"N", -3, 3, Form::kWhole}};
constexpr Number kDrift[] = {{"PPM", -1000, 1000, Form::kWhole}};
constexpr Number kCode[] = {{"CODE", 1, 65535, Form::kCode}};

constexpr Row kRows[] = {
    network_row("cut behind", {}, "the cable behind this robot; of the last one in a ring: back to the master",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.cut_behind = true;
                  done(answer, "the cable behind this robot is cut");
                }),
    network_row("heal behind", {}, "puts a new cable there",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.cut_behind = false;
                  done(answer, "the cable behind this robot is whole");
                }),
    network_row("cut", {}, "the cable before this robot: it and those behind it are not reached from there",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.cut = true;
                  done(answer, "the cable before this robot is cut");
                }),
    network_row("heal", {}, "puts a new cable there",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.cut = false;
                  done(answer, "the cable before this robot is whole");
                }),
    network_row("lose next", kHowMany, "so many frames pass the robots and do not come back",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.lose_next = static_cast<std::uint32_t>(r.numbers[0]);
                  done(answer, "the next frames do not come back");
                }),
    network_row("lose every", kEvery, "one of N frames does not come back; 0 ends it",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.lose_every = static_cast<std::uint32_t>(r.numbers[0]);
                  done(answer, f.lose_every > 0 ? "some frames do not come back" : "all frames come back");
                }),
    network_row("lose mails", {}, "mails of the robot are fetched, and the frames with them lost",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.lose_mails = true;
                  done(answer, "mails of the robot are lost on their way");
                }),
    network_row("no mailbox", {}, "mails to the robot are taken and never answered",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.no_mailbox = true;
                  done(answer, "mails are not answered");
                }),
    network_row("working counter", kAdded, "so much is added to that of the process data; 0 ends it",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.working_counter = static_cast<int>(r.numbers[0]);
                  done(answer,
                       f.working_counter != 0 ? "the working counter is wrong" : "the working counter is right");
                }),
    network_row("clock drift", kDrift, "so much faster runs the robot's clock, on top of --clock-ppm; 0 ends it",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.clock_drift = static_cast<std::int32_t>(r.numbers[0]);
                  done(answer, f.clock_drift != 0 ? "the clock drifts" : "the clock drifts no more than by itself");
                }),
    network_row("foreign on", {}, "another maker's device in the robot's place, until 'foreign off'",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.foreign = true;
                  done(answer, "another maker's device is in the robot's place");
                }),
    network_row("foreign off", {}, "the robot is back, and starts up",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.foreign = false;
                  done(answer, "the robot is in its place");
                }),
    network_row("refuse state", kCode, "every state above PREOP, with this AL status code, e.g. 0x0025",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.refuse_state = static_cast<std::uint16_t>(r.numbers[0]);
                  done(answer, "states above PREOP are refused");
                }),
    network_row("al error", kCode, "once: the robot leaves OP with this AL status code, e.g. 0x001B",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  ++f.events.al_errors;
                  f.events.al_error = static_cast<std::uint16_t>(r.numbers[0]);
                  done(answer, "the robot raises an AL error");
                }),
    network_row("emergency", kCode, "once: a CoE emergency message with this code, e.g. 0xFF00",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  ++f.events.emergencies;
                  f.events.emergency = static_cast<std::uint16_t>(r.numbers[0]);
                  done(answer, "the robot sends an emergency message");
                }),
};

}  // namespace

std::span<const Row> ethercat_rows() noexcept { return kRows; }

}  // namespace meca::sim
