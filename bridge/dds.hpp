// A DDS participant with typed writers and readers, without the vendor's headers: dds.cpp is the only file that
// includes them, and hides the differences of Fast DDS 2.9 and 3. Used by the bridge, meca-ctl and the tests.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace meca::dds {

// DDS could not be opened or refused something; what() is a sentence for the user.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ParticipantOptions {
  int domain = 0;  // 0..232
  std::string name = "meca";
  std::vector<std::string> interfaces;  // IPv4 addresses to use; empty = all
  bool shared_memory = true;            // false: UDP only (containers that do not share /dev/shm)
};

enum class Reliability { kBestEffort, kReliable };
enum class Durability { kVolatile, kTransientLocal };

struct Qos {
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  int depth = 1;                        // KEEP_LAST depth per instance; 0 = KEEP_ALL within max_samples
  int max_samples = 0;                  // KEEP_ALL: at most so many per instance; 0 = unlimited
  int max_instances = 0;                // 0 = unlimited; a reader with a limit forgets dead instances first
  std::chrono::nanoseconds lifespan{};  // writers: samples older than this are forgotten; 0 = never
};

using ParticipantId = std::array<std::byte, 12>;  // GUID prefix: unique per participant, and so per process

struct SampleInfo {
  bool valid_data = false;          // false: the sample only says that an instance or its writers are gone
  ParticipantId participant{};      // the writer's
  std::int64_t source_time_ns = 0;  // Unix time of write()
};

class Participant;

namespace detail {
struct WriterImpl;
struct ReaderImpl;
bool write(WriterImpl& writer, const void* sample) noexcept;
int matched(const WriterImpl& writer) noexcept;
int matched(const ReaderImpl& reader) noexcept;
bool take(ReaderImpl& reader, void* sample, SampleInfo& info) noexcept;
}  // namespace detail

// T is a generated IDL type. Movable; lives no longer than its participant.
template <typename T>
class Writer {
 public:
  Writer() = default;
  // False when the middleware refused the sample. May block up to the vendor's max_blocking_time (KEEP_ALL only).
  bool write(const T& sample) noexcept { return detail::write(*impl_, &sample); }
  int matched() const noexcept { return detail::matched(*impl_); }
  explicit operator bool() const noexcept { return impl_ != nullptr; }

 private:
  friend class Participant;
  explicit Writer(std::shared_ptr<detail::WriterImpl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<detail::WriterImpl> impl_;
};

template <typename T>
class Reader {
 public:
  Reader() = default;
  // Takes the oldest sample, if any.
  bool take(T& sample, SampleInfo& info) noexcept { return detail::take(*impl_, &sample, info); }
  int matched() const noexcept { return detail::matched(*impl_); }
  explicit operator bool() const noexcept { return impl_ != nullptr; }

 private:
  friend class Participant;
  explicit Reader(std::shared_ptr<detail::ReaderImpl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<detail::ReaderImpl> impl_;
};

class Participant {
 public:
  explicit Participant(const ParticipantOptions& options);  // throws Error
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // Defined for every topic type of idl/ (explicit instantiations in dds.cpp). Throw Error.
  template <typename T>
  Writer<T> create_writer(const std::string& topic, const Qos& qos);
  template <typename T>
  Reader<T> create_reader(const std::string& topic, const Qos& qos);

  // Waits until a reader of this participant has data or the time is over; true when there is data. For one thread
  // at a time, which then takes from every reader of this participant: what is left there ends the next wait at once.
  bool wait_for_data(std::chrono::nanoseconds timeout);

  ParticipantId id() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meca::dds
