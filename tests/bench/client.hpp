// A client of the bridge as the proofs need it: sends, renews, collects receipts. One robot, "arm1".
//
// On loopback and by UDP, as between machines: Fast DDS 2.9 loses participants that come after one that was killed when
// they meet in shared memory. It removes the dead one's port while others go on writing into it (its issue 5469, pull
// request 4728), and the proofs kill a lot.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>

#include "bridge/dds.hpp"
#include "idl/types.hpp"

namespace meca::bench {

inline constexpr const char* kRobot = "arm1";

// The same for a bridge: the key `dds` up to where its topics may follow.
std::string dds_on_loopback(int domain);
dds::ParticipantOptions on_loopback(int domain, const std::string& name);
inline bool is_terminal(meca500::ReceiptState state) { return state >= meca500::ReceiptState::COMPLETED; }

class Client {
 public:
  Client(int domain, std::string name);  // throws dds::Error

  const std::string& name() const { return name_; }
  // The bridge reads our commands, and we its receipts.
  bool connected() const { return commands_.matched() > 0 && leases_.matched() > 0 && receipts_.matched() > 0; }

  // The next command; send() gives it its id. Ids count up from the time of day, as those of a restarted program must.
  static meca500::Command make(meca500::CommandKind kind, std::initializer_list<double> arguments = {});
  static meca500::Command make_motion(std::uint32_t id, std::initializer_list<double> arguments,
                                      bool report_completion);
  std::uint64_t reserve_id() { return next_id_++; }
  std::uint64_t send(meca500::Command command) { return send(std::move(command), reserve_id()); }
  std::uint64_t send(meca500::Command command, std::uint64_t id);
  void renew();
  void send_velocity(float joint1);  // deg/s

  // Hands over what has come for this client, oldest first.
  void take_receipts(const std::function<void(const meca500::CommandReceipt&)>& each);
  // Waits for data of any reader of this participant.
  bool wait(std::chrono::nanoseconds timeout) { return participant_.wait_for_data(timeout); }
  // Sends, renewing meanwhile, until the end of the command. Throws std::runtime_error when there is none within 20 s.
  meca500::CommandReceipt finish(meca500::Command command) { return finish(std::move(command), reserve_id()); }
  meca500::CommandReceipt finish(meca500::Command command, std::uint64_t id);
  // Finds the bridge, takes control as soon as it is given, activates and homes. Throws std::runtime_error.
  void prepare_robot();
  dds::Participant& participant() { return participant_; }

 private:
  std::string name_;
  dds::Participant participant_;
  dds::Writer<meca500::Command> commands_;
  dds::Writer<meca500::ControlLease> leases_;
  dds::Writer<meca500::VelocityCommand> velocities_;
  dds::Reader<meca500::CommandReceipt> receipts_;
  std::uint64_t next_id_;
  std::uint64_t renewals_ = 0, velocity_number_ = 0;
};

}  // namespace meca::bench
