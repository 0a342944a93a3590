#include "sim/panel.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "sim/motion_queue.hpp"
#include "transports/image/error_codes.hpp"
#include "transports/image/nearest.hpp"

namespace meca::sim {
namespace {

using Kind = PanelAnswer::Kind;
using Tokens = std::vector<std::string_view>;

struct Number {
  std::string_view name;
  double minimum, maximum;  // inclusive
  bool whole = false;
  double otherwise = std::numeric_limits<double>::quiet_NaN();  // when left out; NaN: it must be given
  bool optional() const { return !std::isnan(otherwise); }
};

struct Row {
  std::string_view words;
  std::span<const Number> numbers;
  std::string_view about;
  void (*apply)(Robot&, const PanelRequest&, PanelAnswer&) noexcept;
  std::string (*check)(const PanelRequest&) = nullptr;  // a complaint beyond the ranges, or nothing
};

void done(PanelAnswer& answer, std::string_view sentence) noexcept {
  answer.kind = Kind::kDone;
  answer.sentence = sentence;
}
void refused(PanelAnswer& answer, std::string_view sentence) noexcept {
  answer.kind = Kind::kRefused;
  answer.sentence = sentence;
}

void release_e_stop(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  robot.release_e_stop();
  const bool waits = robot.stops().e_stop == StopSignal::kResettable;
  done(answer, waits ? "E-Stop released; the power supply waits for 'press reset'" : "E-Stop released");
}

void press_reset(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  const StopSignals stops = robot.stops();
  if (stops.e_stop == StopSignal::kPresent) {
    return refused(answer, "Reset does nothing while the E-Stop is pressed; 'release e-stop' first");
  }
  if (stops.e_stop == StopSignal::kReset && stops.reboot == StopSignal::kReset) {
    return refused(answer,
                   "there is nothing to reset: neither a released E-Stop nor a reboot waits for the Reset button");
  }
  robot.press_reset_button();
  done(answer, "Reset pressed, no E-Stop and no reboot stops the robot any more");
}

void place_part(Robot& robot, const PanelRequest& request, PanelAnswer& answer) noexcept {
  if (!robot.place_part(request.numbers[0])) {
    return refused(answer, "no part fits: there is no gripper (transport.tool), or it is not open wider than the part");
  }
  done(answer, request.numbers[0] > 0 ? "the part is between the fingers" : "there is no part between the fingers");
}

void release_p_stop2(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  robot.release_p_stop2();
  const bool waits = robot.stops().p_stop2 == StopSignal::kResettable;
  done(answer, waits ? "P-Stop 2 released; the host has to resume motion" : "P-Stop 2 is not pressed");
}

void restore_connection(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  robot.restore_connection();
  const bool waits = robot.stops().connection_dropped == StopSignal::kResettable;
  done(answer, waits ? "connection restored; the host has to resume motion" : "the connection is not dropped");
}

void raise_error(Robot& robot, const PanelRequest& request, PanelAnswer& answer) noexcept {
  if (robot.inputs().robot_status.error_code != 0) {
    return refused(answer, "the robot is in error already and shows the first cause only; reset that error first");
  }
  robot.raise_error(static_cast<std::uint16_t>(request.numbers[0]));
  done(answer, "the robot is in error");
}

std::string known_code(const PanelRequest& request) {
  const auto code = static_cast<std::uint16_t>(request.numbers[0]);
  if (image::find_error_code(code) != nullptr) return {};
  return std::to_string(code) + " is no error code of the Meca500 that any document names; try 1007, joint over limit";
}

void status(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  const image::Inputs& in = robot.inputs();
  const Journal& journal = robot.journal();
  answer.kind = Kind::kStatus;
  answer.status = {.stops = robot.stops(),
                   .present = robot.present(),
                   .monitoring = robot.monitoring(),
                   .activated = in.robot_status.activated,
                   .homed = in.robot_status.homed,
                   .error = in.robot_status.error_code,
                   .queued = static_cast<std::uint16_t>(MotionQueue::kCapacity - in.motion_status.fifo_space),
                   .executed = journal.count(Outcome::kExecuted),
                   .discarded = journal.count(Outcome::kDiscarded),
                   .refused = journal.count(Outcome::kRefused),
                   .violations = robot.violations().size()};
}

template <class Entry>
void list(const Log<Entry>& log, std::uint64_t wanted, std::array<Entry, PanelAnswer::kMostListed>& out,
          PanelAnswer& answer) noexcept {
  answer.total = log.size();
  answer.listed = static_cast<std::size_t>(std::min(wanted, log.size() - log.first()));
  for (std::size_t i = 0; i < answer.listed; ++i) out[i] = log[log.size() - answer.listed + i];
}

void journal(Robot& robot, const PanelRequest& request, PanelAnswer& answer) noexcept {
  answer.kind = Kind::kJournal;
  list(robot.journal(), static_cast<std::uint64_t>(request.numbers[0]), answer.commands, answer);
}

void violations(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  answer.kind = Kind::kViolations;
  list(robot.violations(), PanelAnswer::kMostListed, answer.violations, answer);
}

constexpr Number kCode[] = {{"CODE", 0, 65535, true}};
constexpr Number kWidth[] = {{"MM", 0, 1000}};
constexpr Number kPush[] = {{"JOINT", 1, 6, true}, {"PERCENT", -1000, 1000}};
constexpr Number kSphere[] = {{"X", -1000, 1000}, {"Y", -1000, 1000}, {"Z", -1000, 1000}, {"RADIUS", 1, 1000}};
constexpr Number kHowMany[] = {{"N", 1, PanelAnswer::kMostListed, true, 10}};

// THE place for a new word: one row. Words of one beginning stand together; no row may begin with all words of another.
constexpr Row kRows[] = {
    {"press e-stop",
     {},
     "the emergency stop: the motors lose their power",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.press_e_stop();
       done(answer, "E-Stop pressed");
     }},
    {"press reset", {}, "the Reset button on the power supply of an R4, after the E-Stop was released", press_reset},
    {"press p-stop2",
     {},
     "the protective stop P-Stop 2",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.press_p_stop2();
       done(answer, "P-Stop 2 pressed");
     }},
    {"release e-stop", {}, "an R4 then waits for the Reset button", release_e_stop},
    {"release p-stop2", {}, "the host then has to resume motion", release_p_stop2},
    {"drop connection",
     {},
     "the safety stop 'connection dropped'; the bus itself goes on",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.drop_connection();
       done(answer, "connection dropped");
     }},
    {"restore connection", {}, "the host then has to resume motion", restore_connection},
    {"raise error", kCode, "any error code of the robot, e.g. 1007", raise_error, known_code},
    {"power cycle",
     {},
     "power fails and comes back: the robot is away until it has started up",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.power_cycle();
       done(answer, "the robot starts up");
     }},
    {"place part", kWidth, "a part of this width between the fingers of the gripper, 0 takes it away", place_part},
    {"place obstacle", kSphere,
     "a sphere (mm, base frame) that the robot sees coming; it minds it with SetCollisionCfg",
     [](Robot& robot, const PanelRequest& r, PanelAnswer& answer) noexcept {
       robot.place_obstacle(r.numbers[0], r.numbers[1], r.numbers[2], r.numbers[3]);
       done(answer, "the obstacle is there");
     }},
    {"remove obstacle",
     {},
     "takes it away",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.place_obstacle(0, 0, 0, 0);
       done(answer, "there is no obstacle");
     }},
    {"push joint", kPush,
     "an outside force, as torque in percent of what the motor can give; stays until changed, 0 ends it",
     [](Robot& robot, const PanelRequest& r, PanelAnswer& answer) noexcept {
       robot.push(static_cast<int>(r.numbers[0]), r.numbers[1]);
       done(answer, r.numbers[1] != 0 ? "somebody pushes the joint" : "nobody pushes the joint");
     }},
    {"monitoring on",
     {},
     "the robot ignores what this host sends",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.set_monitoring(true);
       done(answer, "the robot only lets this host watch");
     }},
    {"monitoring off",
     {},
     "the robot obeys this host again",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.set_monitoring(false);
       done(answer, "the robot listens to this host");
     }},
    {"status", {}, "what is pressed, error, queue, counts", status},
    {"violations", {}, "the rules of the protocol that the host broke", violations},
    {"journal", kHowMany, "the last N commands (10) and what became of them", journal},
    {"help",
     {},
     "these words",
     [](Robot&, const PanelRequest&, PanelAnswer& answer) noexcept { answer.kind = Kind::kHelp; }},
};

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

// ---- one line of text to a request

Tokens split(std::string_view text) {
  Tokens tokens;
  while (!text.empty()) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t end = std::min(text.find_first_of(" \t", begin), text.size());
    if (end > begin) tokens.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
  return tokens;
}

// How many of the tokens are the words of the row; 0 when it is another row that is meant.
std::size_t matched(const Row& row, const Tokens& tokens) {
  const Tokens words = split(row.words);
  const bool same = tokens.size() >= words.size() && std::equal(words.begin(), words.end(), tokens.begin());
  return same ? words.size() : 0;
}

std::string usage(const Row& row) {
  std::string text(row.words);
  for (const Number& number : row.numbers) {
    text += number.optional() ? " [" + std::string(number.name) + "]" : " " + std::string(number.name);
  }
  return text;
}

// Of two words the second is not guessed: e-stop and p-stop2 are near to each other, and not the same.
std::string no_such_word(const Tokens& tokens) {
  std::vector<std::string_view> known;
  std::string second_words, first_usage;
  for (const Row& row : kRows) {
    known.push_back(row.words);
    const Tokens words = split(row.words);
    if (words.size() < 2 || words[0] != tokens[0]) continue;
    if (first_usage.empty()) first_usage = usage(row);
    second_words += (second_words.empty() ? "" : ", ") + std::string(words[1]);
  }
  if (!second_words.empty() && tokens.size() == 1) {
    return quoted(tokens[0]) + " wants a second word: " + second_words + "; say for example " + quoted(first_usage);
  }
  if (!second_words.empty())
    return quoted(tokens[0]) + " does not take " + quoted(tokens[1]) + ", only " + second_words;
  const std::string said = std::string(tokens[0]) + (tokens.size() > 1 ? " " + std::string(tokens[1]) : "");
  std::string_view meant = image::nearest(said, known);
  if (meant.empty()) meant = image::nearest(tokens[0], known);  // a word that takes numbers
  return "there is no word " + quoted(said) +
         (meant.empty() ? "; 'help' lists them" : ", did you mean " + quoted(meant) + "?");
}

std::string in_words(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string read_number(const Number& number, std::string_view token, double& out) {
  const char* end = token.data() + token.size();
  const auto [rest, error] = std::from_chars(token.data(), end, out);
  const bool good = error == std::errc{} && rest == end && std::isfinite(out) &&
                    (!number.whole || out == std::floor(out)) && out >= number.minimum && out <= number.maximum;
  if (good) return {};
  return std::string(number.name) + ": found " + quoted(token) + "; expected a " + (number.whole ? "whole " : "") +
         "number from " + in_words(number.minimum) + " to " + in_words(number.maximum);
}

// Fills the request; returns the complaint, or nothing.
std::string read_numbers(const Row& row, std::span<const std::string_view> tokens, PanelRequest& request) {
  if (tokens.size() > row.numbers.size()) {
    return quoted(row.words) + " does not take " + quoted(tokens[row.numbers.size()]) + "; say " + quoted(usage(row));
  }
  for (std::size_t i = 0; i < row.numbers.size(); ++i) {
    const Number& number = row.numbers[i];
    if (i >= tokens.size()) {
      if (!number.optional()) {
        return quoted(row.words) + " wants " + std::string(number.name) + "; say " + quoted(usage(row));
      }
      request.numbers[i] = number.otherwise;
    } else if (auto complaint = read_number(number, tokens[i], request.numbers[i]); !complaint.empty()) {
      return complaint;
    }
  }
  return row.check != nullptr ? row.check(request) : std::string();
}

// Lower case, or the complaint about the first byte that nobody types.
bool normalise(std::string_view line, std::string& out) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if ((c < ' ' || c > '~') && c != '\t') {
      out = "byte " + std::to_string(i + 1) + " of the line is not printable ASCII; words are separated by blanks";
      return false;
    }
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return true;
}

}  // namespace

std::variant<PanelRequest, std::string> parse_panel_line(std::string_view line) {
  std::string text;
  if (!normalise(line, text)) return text;
  const Tokens tokens = split(text);
  if (tokens.empty()) return std::string("the line is empty; 'help' lists the words");
  for (std::size_t i = 0; i < std::size(kRows); ++i) {
    const std::size_t words = matched(kRows[i], tokens);
    if (words == 0) continue;
    PanelRequest request{.word = static_cast<std::uint8_t>(i)};
    auto complaint = read_numbers(kRows[i], std::span(tokens).subspan(words), request);
    if (!complaint.empty()) return complaint;
    return request;
  }
  return no_such_word(tokens);
}

void apply(const PanelRequest& request, Robot& robot, PanelAnswer& answer) noexcept {
  kRows[request.word].apply(robot, request, answer);
}

std::string panel_help() {
  std::size_t width = 0;
  for (const Row& row : kRows) width = std::max(width, usage(row).size());
  std::string text;
  for (const Row& row : kRows) {
    std::string line = usage(row);
    if (!row.about.empty()) line += std::string(width + 2 - line.size(), ' ') + std::string(row.about);
    text += line + "\n";
  }
  return text;
}

}  // namespace meca::sim
