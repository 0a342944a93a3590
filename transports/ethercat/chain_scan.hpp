// Looks through the chain: counts the devices, knows those again that still have the station address it gave them,
// gives the others one, takes the mapping of other masters from them, and reads who they are. A machine without I/O and
// without clock that wants datagrams and takes answers. No allocation after construction.
//
// By position only what a device has under its address 0010h is read, and only a device that has none of ours is
// written to. So a running device is never touched, whoever comes, goes or moves around it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "transports/ethercat/in_flight.hpp"
#include "transports/ethercat/sii_reader.hpp"
#include "transports/text.hpp"

namespace meca::ethercat {

class ChainScan {
 public:
  static constexpr std::size_t kMostDevices = 64;
  static constexpr std::uint16_t kFirstAddress = 0x1001;

  struct Device {
    std::uint16_t address = 0, position = 0;
    std::uint16_t features = 0, dl_status = 0, alias = 0;
    bool identified = false;  // `identity` was read
    SiiIdentity identity{};
    FixedText<127> trouble{};  // why it could not be read
    std::uint32_t life = 0;    // another number for every address given: a power cycle makes another life of it
  };

  explicit ChainScan(Time sii_timeout);

  void start() noexcept;
  void stop() noexcept;  // devices() stay as they were
  bool running() const noexcept { return step_ != Step::kIdle || ended_; }
  // It addresses by position: in an open ring two devices would answer, so such frames go out of one port only.
  bool by_position() const noexcept;
  void tick(Time now) noexcept;  // of the SII readers
  // Adds what it wants to know now to the frame, as far as it fits; false when there was nothing to add.
  bool add_to(InFlight& frame, Time now) noexcept;
  void answered(const Purpose& purpose, std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void lost(const Purpose& purpose, Time now) noexcept;
  // Once after each end: devices() is true again. Where the chain changes on the way it begins again by itself.
  bool take_end() noexcept;

  std::span<const Device> devices() const noexcept { return devices_; }  // in the order of their positions
  std::size_t count() const noexcept { return count_; }                  // that answered by position

 private:
  enum class Step : std::uint8_t { kIdle, kCount, kAddresses, kOthers, kAssign, kRead };
  enum class Ask : std::uint8_t { kMapping, kFeatures, kDlStatus, kAlias, kSii, kDone };
  struct Probe {  // of a position in kAddresses, else of a device
    bool answered = false, asked = false;
    std::uint16_t address = 0;
    Ask ask = Ask::kFeatures;
    unsigned failures = 0;
    SiiReader sii;
  };

  void begin(Step step) noexcept;
  void next_step(Time now) noexcept;
  void recognise() noexcept;
  void take_others() noexcept;
  void give_addresses() noexcept;
  bool taken(std::uint16_t address) const noexcept;
  std::size_t items() const noexcept;
  bool add_item(InFlight& frame, std::size_t item, Time now) noexcept;
  bool add_reading(InFlight& frame, std::size_t item, Time now) noexcept;
  void answered_reading(std::size_t item, std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void sii_moved(std::size_t item) noexcept;

  Step step_ = Step::kIdle;
  std::uint8_t generation_ = 0;  // of the step, so that an old answer is not taken for a new one
  bool ended_ = false;
  std::size_t count_ = 0;
  std::uint32_t lives_ = 0;
  std::vector<Device> devices_, next_devices_;
  std::vector<Probe> probes_;
  std::size_t first_item_ = 0;  // who is asked first when not all fit in one frame
};

}  // namespace meca::ethercat
