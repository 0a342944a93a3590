// The CANopen server of a device: the payload of a mail in, the payload of the answer out; SDO transfers expedited,
// normal and segmented in both directions, Complete Access, SDO information (ETG.1000.6, 5.6.2 and 5.6.3). A machine
// without I/O; no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "transports/ethercat/mailbox.hpp"
#include "transports/ethercat/object_dictionary.hpp"

namespace meca::ethercat {

class CoeServer {
 public:
  // What fits behind the mailbox header.
  static constexpr std::size_t kMostPayload = kMailboxSize - kMailboxHeader;

  // One request. The answer goes into `out` (kMostPayload bytes), if there is one. A mail that makes no sense: what the
  // mailbox error reply has to say.
  std::optional<MailboxError> request(ObjectDictionary& objects, Bytes payload, AlState state,
                                      wire::Writer& out) noexcept;
  // Answers come in fragments when they are long: the next, once the last one was fetched. Nothing written: it was all.
  void next_fragment(const ObjectDictionary& objects, wire::Writer& out) noexcept;

  void reset() noexcept;  // forgets what was going on
  std::uint64_t aborts() const noexcept { return aborts_; }

 private:
  enum class Transfer : std::uint8_t { kNone, kUpload, kDownload };
  static constexpr std::size_t kMostValue = 512;

  void sdo(ObjectDictionary& objects, const SdoMessage& message, AlState state, wire::Writer& out) noexcept;
  void begin_upload(const ObjectDictionary& objects, const SdoMessage& request, AlState state,
                    wire::Writer& out) noexcept;
  void continue_upload(const SdoMessage& request, wire::Writer& out) noexcept;
  void begin_download(ObjectDictionary& objects, const SdoMessage& request, AlState state, wire::Writer& out) noexcept;
  void continue_download(ObjectDictionary& objects, const SdoMessage& request, AlState state,
                         wire::Writer& out) noexcept;
  bool in_turn(Transfer transfer, const SdoMessage& request, wire::Writer& out) noexcept;
  void abort(SdoAbort code, wire::Writer& out) noexcept;

  void information(const ObjectDictionary& objects, wire::Reader& in, wire::Writer& out) noexcept;

  Transfer transfer_ = Transfer::kNone;
  SdoAddress address_;
  bool complete_access_ = false, toggle_ = false;
  std::array<std::byte, kMostValue> value_{};
  std::size_t size_ = 0, at_ = 0;
  std::uint64_t aborts_ = 0;

  std::uint16_t list_ = 0;   // of SDO information: which list is being sent
  std::size_t list_at_ = 0;  // entries that were sent
  std::uint16_t fragments_left_ = 0;
};

}  // namespace meca::ethercat
