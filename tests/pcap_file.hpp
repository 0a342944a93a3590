// Frames into a file that tshark, tcpdump and Wireshark read: classic pcap, with nanoseconds.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>

namespace meca::test {

class PcapFile {
 public:
  enum class Link : std::uint32_t { kEthernet = 1 };

  explicit PcapFile(const std::filesystem::path& path, Link link = Link::kEthernet) : out_(path, std::ios::binary) {
    if (!out_) throw std::runtime_error(path.string() + " cannot be written");
    constexpr std::uint32_t kNanoseconds = 0xA1B23C4D, kLongest = 65535;
    constexpr std::uint32_t kVersion = 4U << 16 | 2;  // 2.4
    for (const std::uint32_t word : {kNanoseconds, kVersion, 0U, 0U, kLongest, static_cast<std::uint32_t>(link)}) {
      u32(word);
    }
  }

  void add(std::span<const std::byte> frame, std::chrono::nanoseconds at) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    const auto size = static_cast<std::uint32_t>(frame.size());
    u32(static_cast<std::uint32_t>(at.count() / kSecond));
    u32(static_cast<std::uint32_t>(at.count() % kSecond));
    u32(size);
    u32(size);
    out_.write(reinterpret_cast<const char*>(frame.data()), static_cast<std::streamsize>(frame.size()));
    ++frames_;
  }
  std::size_t frames() const { return frames_; }
  void flush() { out_.flush(); }

 private:
  void u32(std::uint32_t value) { out_.write(reinterpret_cast<const char*>(&value), sizeof value); }  // of this machine

  std::ofstream out_;
  std::size_t frames_ = 0;
};

}  // namespace meca::test
