// What people may do to the network of a simulated robot that is behind one, whatever the bus.
#include "sim/panel_table.hpp"

namespace meca::sim {
namespace {

constexpr Number kLate[] = {{"MS", 0, 60'000}};

constexpr Row kRows[] = {
    network_row("unplug", {}, "the cable is out: nothing goes in or out until 'plug'; EtherCAT: both cables",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.unplugged = true;
                  done(answer, "the cable is out");
                }),
    network_row("plug", {}, "puts it back",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.unplugged = false;
                  done(answer, "the cable is in");
                }),
    network_row("power off", {}, "the robot has no power until 'power on'; then it starts up",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.without_power = true;
                  done(answer, "the robot has no power");
                }),
    network_row("power on", {}, "gives it back",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.without_power = false;
                  done(answer, "the robot has power");
                }),
    network_row("freeze", {}, "answers messages and mails but handles no I/O, until 'thaw'",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.frozen = true;
                  done(answer, "no I/O is handled");
                }),
    network_row("thaw", {}, "handles I/O again",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.frozen = false;
                  done(answer, "I/O is handled");
                }),
    network_row("late", kLate, "explicit messages (EtherCAT: all frames) are answered so much later; 0 ends it",
                [](NetworkFaults& f, const PanelRequest& r, PanelAnswer& answer) noexcept {
                  f.late = std::chrono::duration_cast<Time>(std::chrono::duration<double, std::milli>(r.numbers[0]));
                  done(answer, f.late > Time::zero() ? "answers are late" : "answers come at once");
                }),
    network_row("duplicate", {}, "every T->O packet twice; EtherCAT: every frame comes back twice",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.duplicate = true;
                  done(answer, "what the robot sends comes twice");
                }),
    network_row("corrupt", {}, "T->O packets of a wrong length; EtherCAT: of every frame half comes back",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  f.corrupt = true;
                  done(answer, "what the robot sends is too short");
                }),
    network_row("faults off", {}, "ends everything that is wrong with the network; buttons and errors stay",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  NetworkFaults healthy;
                  healthy.bus = f.bus;
                  healthy.events = f.events;
                  f = healthy;
                  done(answer, "the network is healthy");
                }),
    network_row("faults", {}, "what is wrong with the network now",
                [](NetworkFaults& f, const PanelRequest&, PanelAnswer& answer) noexcept {
                  answer.kind = PanelAnswer::Kind::kFaults;
                  answer.faults = f;
                }),
};

}  // namespace

std::span<const Row> network_rows() noexcept { return kRows; }

}  // namespace meca::sim
