// Start-up of independent masters with independent devices, played to this ESC: the same requests have to give the same
// answers. Recorded between SOEM, ethercrab, libethercat, KickCAT and SOES (tests/captures/ethercat/esc); no robot was
// there.
#include <fstream>
#include <sstream>

#include "tests/unit/ethercat/esc_wire.hpp"
#include "transports/ethercat/registers.hpp"

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;

struct Line {
  std::uint8_t command;
  std::uint16_t adp, ado;
  std::vector<std::byte> sent;
  std::uint16_t answered_adp;
  std::vector<std::byte> answered;
  unsigned wkc;
  std::string text;
};

std::vector<Line> load(const std::string& name) {
  std::ifstream file(std::string(MECA_SOURCE_DIR) + "/tests/captures/ethercat/esc/" + name + ".txt");
  std::vector<Line> lines;
  for (std::string text; std::getline(file, text);) {
    if (text.starts_with('#')) continue;
    std::istringstream in(text);
    unsigned command = 0, adp = 0, ado = 0, answered_adp = 0, wkc = 0;
    std::string sent, answered;
    in >> std::hex >> command >> adp >> ado >> sent >> answered_adp >> answered >> std::dec >> wkc;
    lines.push_back({static_cast<std::uint8_t>(command), static_cast<std::uint16_t>(adp),
                     static_cast<std::uint16_t>(ado), test::hex(sent), static_cast<std::uint16_t>(answered_adp),
                     test::hex(answered), wkc, text});
  }
  return lines;
}

// What kind of device answered. The SII as far as it was read: 4 bytes at 0508 after a command with that word address,
// and what the ESC shows of it; with a checksum that fits the parts of it that no master asked for.
EscSettings settings_of(const std::vector<Line>& lines) {
  EscSettings settings;
  settings.sii_busy = 0ns;
  settings.sii.assign(2 * sii::kCategories, std::byte{0});
  settings.sii.resize(2048, std::byte{0xFF});
  const auto learn = [&settings](std::size_t word, Bytes bytes) {
    if (2 * word + bytes.size() <= settings.sii.size())
      std::ranges::copy(bytes, settings.sii.begin() + static_cast<std::ptrdiff_t>(2 * word));
  };
  std::size_t word = 0;
  for (const Line& line : lines) {
    if (line.ado == reg::kSiiControl && line.sent.size() == 6) word = test::number(Bytes(line.sent).subspan(2));
    if (line.ado == reg::kSiiAddress && line.sent.size() == 4) word = test::number(line.sent);
    if (line.ado == reg::kSiiData && line.answered.size() == 4) learn(word, line.answered);
    if (line.ado == reg::kPdiControl) learn(0, line.answered);
    if (line.ado == reg::kFeatures) settings.features = static_cast<std::uint16_t>(test::number(line.answered));
  }
  settings.sii[2 * sii::kChecksum] = std::byte{sii_checksum(Bytes(settings.sii).first(2 * sii::kChecksum))};
  return settings;
}

// What has to differ: which chip it is (0000 to 0009), and what its clock shows.
bool is_its_own(const Line& line) {
  return line.ado < reg::kStationAddress ||
         (line.ado >= reg::kDcReceiveTimes && line.ado < reg::kDcOffset && line.answered != line.sent);
}

struct Recording {
  const char* name;
  std::size_t devices;
  friend void PrintTo(const Recording& r, std::ostream* out) { *out << r.name; }
};

class EscCapture : public testing::TestWithParam<Recording> {};

TEST_P(EscCapture, IsAnsweredAsTheRecordedDevicesDid) {
  const auto lines = load(GetParam().name);
  ASSERT_GT(lines.size(), 100u);
  const EscSettings settings = settings_of(lines);
  std::vector<Esc> row;
  for (std::size_t i = 0; i < GetParam().devices; ++i) {
    row.emplace_back(settings);
    row.back().set_ports({{true, i + 1 < GetParam().devices, false, false}});
  }
  Time now{};
  for (const Line& line : lines) {
    test::Passing passing(line.command, address_of(line.adp, line.ado), line.sent);
    now += 50us;
    for (Esc& esc : row) {
      // The application is not at hand: AL status as recorded.
      if (line.ado == reg::kAlStatus) esc.set_al_status(static_cast<std::uint16_t>(test::number(line.answered)), 0);
      esc.frame_begins(now, std::nullopt);
      esc.process(passing.datagram(), now);
    }
    const test::Reply reply = passing.reply();
    EXPECT_EQ(reply.wkc, line.wkc) << line.text;
    EXPECT_EQ(reply.adp, line.answered_adp) << line.text;
    if (is_its_own(line)) continue;
    auto expected = line.answered;
    // KickCAT's simulator never says that its PDI is operational.
    if (line.ado == reg::kDlStatus) expected[0] |= std::byte{0x01};
    EXPECT_EQ(reply.hex(), test::text(expected)) << line.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Start, EscCapture,
                         testing::Values(Recording{"soem2-vs-soes-fw10", 1}, Recording{"ethercrab-vs-3-devices", 3},
                                         Recording{"libethercat-vs-kickcat", 1}, Recording{"kickcat-vs-soes-fw9", 1}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace meca::ethercat
