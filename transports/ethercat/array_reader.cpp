#include "transports/ethercat/array_reader.hpp"

namespace meca::ethercat {

void ArrayReader::read(std::uint16_t index, std::size_t entry_size, Time now) noexcept {
  begin();
  index_ = index;
  entry_size_ = entry_size;
  count_ = 0;
  whole_ = !whole_refused_;
  sdo_.upload({index, 0}, whole_, now);
}

void ArrayReader::tick(Time now) noexcept {
  if (!running()) return;
  sdo_.tick(now);
  proceed(now);
}

void ArrayReader::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (!running()) return;
  sdo_.answered(working_counter, data, now);
  proceed(now);
}

void ArrayReader::proceed(Time now) noexcept {
  if (sdo_.running()) return;
  const bool failed = sdo_.outcome() == Outcome::kFailed;
  if (failed && !(whole_ && sdo_.abort())) return fail(sdo_.trouble());
  if (!whole_) return take_entry(now);
  if (!failed && take_whole()) return done();
  // Whatever it says against Complete Access; an object that is not there is refused once more below.
  whole_ = false;
  ask(0, now);
}

// Complete Access: subindex 0 stands in 16 bits (ETG.1000.6, 5.6.2.3).
bool ArrayReader::take_whole() noexcept {
  const Bytes value = sdo_.value();
  if (value.size() < 2) return false;
  count_ = u8_at(value, 0);
  if (count_ > kMostEntries || value.size() < 2 + count_ * entry_size_) return false;
  for (std::size_t i = 0; i < count_; ++i) entries_[i] = number(2 + i * entry_size_);
  return true;
}

void ArrayReader::take_entry(Time now) noexcept {
  const std::uint8_t sub = sdo_.address().sub;
  if (sdo_.value().size() < (sub == 0 ? 1 : entry_size_)) {
    return fail(Predicate::format("has object 0x%04X:%02X with only %zu bytes; check its firmware", unsigned{index_},
                                  unsigned{sub}, sdo_.value().size()));
  }
  if (sub == 0) {
    whole_refused_ = true;  // and it can be read otherwise
    count_ = std::min<std::size_t>(u8_at(sdo_.value(), 0), kMostEntries);
  } else {
    entries_[sub - 1U] = number(0);
  }
  if (sub == count_) return done();
  ask(static_cast<std::uint8_t>(sub + 1), now);
}

void ArrayReader::ask(std::uint8_t sub, Time now) noexcept { sdo_.upload({index_, sub}, false, now); }

std::uint32_t ArrayReader::number(std::size_t at) const noexcept {
  std::uint32_t out = 0;
  for (std::size_t i = entry_size_; i-- > 0;) out = out << 8 | u8_at(sdo_.value(), at + i);
  return out;
}

}  // namespace meca::ethercat
