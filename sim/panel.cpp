#include "sim/panel.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "sim/panel_table.hpp"
#include "transports/image/nearest.hpp"

namespace meca::sim {
namespace {

using Tokens = std::vector<std::string_view>;

struct Table {
  std::span<const Row> (*rows)() noexcept;
  std::string_view heading;     // in the help
  std::optional<Fieldbus> bus;  // the only one that its words are for
};
constexpr Table kTables[] = {{robot_rows, "", {}},
                             {network_rows, "and with a network in between (meca-sim):\n", {}},
                             {ethernet_ip_rows, "on EtherNet/IP:\n", Fieldbus::kEthernetIp},
                             {ethercat_rows, "on EtherCAT:\n", Fieldbus::kEthercat}};

struct Place {
  const Table* table;
  const Row* row;
};
Place place_of(std::size_t word) noexcept {
  const Table* table = kTables;
  while (word >= table->rows().size()) word -= (table++)->rows().size();
  return {table, &table->rows()[word]};
}
std::size_t row_count() noexcept {
  std::size_t count = 0;
  for (const Table& table : kTables) count += table.rows().size();
  return count;
}
const Row& row_of(std::size_t word) noexcept { return *place_of(word).row; }

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

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
  for (std::size_t i = 0; i < row_count(); ++i) {
    const Row& row = row_of(i);
    known.push_back(row.words);
    const Tokens words = split(row.words);
    if (words.size() < 2 || words[0] != tokens[0]) continue;
    if (first_usage.empty()) first_usage = usage(row);
    second_words += (second_words.empty() ? "" : ", ") + std::string(words[1]);
  }
  if (!second_words.empty() && tokens.size() == 1) {
    return in_quotes(tokens[0]) + " wants a second word: " + second_words + "; say for example " +
           in_quotes(first_usage);
  }
  if (!second_words.empty())
    return in_quotes(tokens[0]) + " does not take " + in_quotes(tokens[1]) + ", only " + second_words;
  const std::string said = std::string(tokens[0]) + (tokens.size() > 1 ? " " + std::string(tokens[1]) : "");
  std::string_view meant = image::nearest(said, known);
  if (meant.empty()) meant = image::nearest(tokens[0], known);  // a word that takes numbers
  return "there is no word " + in_quotes(said) +
         (meant.empty() ? "; 'help' lists them" : ", did you mean " + in_quotes(meant) + "?");
}

std::string in_words(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed).ptr;
  return {buffer.data(), end};
}

// A.B.C.D:PORT to ipv4 * 65536 + port.
bool read_address(std::string_view token, double& out) {
  constexpr std::string_view kSeparators = "...:";
  out = 0;
  for (std::size_t i = 0; i <= kSeparators.size(); ++i) {
    const bool port = i == kSeparators.size();
    const std::size_t end = port ? token.size() : token.find(kSeparators[i]);
    if (end == std::string_view::npos) return false;
    unsigned part = 0;
    const auto [rest, error] = std::from_chars(token.data(), token.data() + end, part);
    if (error != std::errc{} || rest != token.data() + end || part > (port ? 65535u : 255u)) return false;
    out = out * (port ? 65536 : 256) + part;
    token.remove_prefix(port ? end : end + 1);
  }
  return true;
}

bool read_code(std::string_view token, double& out) {
  const bool hex = token.starts_with("0x");
  if (hex) token.remove_prefix(2);
  std::uint32_t code = 0;
  const auto [rest, error] = std::from_chars(token.data(), token.data() + token.size(), code, hex ? 16 : 10);
  out = code;
  return error == std::errc{} && rest == token.data() + token.size();
}

bool read_real(std::string_view token, double& out) {
  const auto [rest, error] = std::from_chars(token.data(), token.data() + token.size(), out);
  return error == std::errc{} && rest == token.data() + token.size() && std::isfinite(out);
}

std::string expected(const Number& number) {
  const std::string range = " from " + in_words(number.minimum) + " to " + in_words(number.maximum);
  switch (number.form) {
    case Number::Form::kReal:
      return "a number" + range;
    case Number::Form::kWhole:
      return "a whole number" + range;
    case Number::Form::kCode:
      return "a whole number" + range + ", or in hex, 0x...";
    case Number::Form::kAddress:
      return "an IPv4 address and a port, e.g. 192.0.2.9:2222";
  }
  return {};
}

bool read_form(const Number& number, std::string_view token, double& out) {
  const auto in_range = [&] { return out >= number.minimum && out <= number.maximum; };
  switch (number.form) {
    case Number::Form::kReal:
      return read_real(token, out) && in_range();
    case Number::Form::kWhole:
      return read_real(token, out) && out == std::floor(out) && in_range();
    case Number::Form::kCode:
      return read_code(token, out) && in_range();
    case Number::Form::kAddress:
      return read_address(token, out);
  }
  return false;
}

std::string read_number(const Number& number, std::string_view token, double& out) {
  if (read_form(number, token, out)) return {};
  return std::string(number.name) + ": found " + in_quotes(token) + "; expected " + expected(number);
}

// Fills the request; returns the complaint, or nothing.
std::string read_numbers(const Row& row, std::span<const std::string_view> tokens, PanelRequest& request) {
  if (tokens.size() > row.numbers.size()) {
    return in_quotes(row.words) + " does not take " + in_quotes(tokens[row.numbers.size()]) + "; say " +
           in_quotes(usage(row));
  }
  for (std::size_t i = 0; i < row.numbers.size(); ++i) {
    const Number& number = row.numbers[i];
    if (i >= tokens.size()) {
      if (!number.optional()) {
        return in_quotes(row.words) + " wants " + std::string(number.name) + "; say " + in_quotes(usage(row));
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
  for (std::size_t i = 0; i < row_count(); ++i) {
    const std::size_t words = matched(row_of(i), tokens);
    if (words == 0) continue;
    PanelRequest request{.word = static_cast<std::uint8_t>(i)};
    auto complaint = read_numbers(row_of(i), std::span(tokens).subspan(words), request);
    if (!complaint.empty()) return complaint;
    return request;
  }
  return no_such_word(tokens);
}

std::string_view misplaced(const PanelRequest& request, Fieldbus bus) noexcept {
  const auto only = place_of(request.word).table->bus;
  if (!only || *only == bus) return {};
  switch (bus) {
    case Fieldbus::kEthernetIp:
      return "that is a word for EtherCAT, and this robot is on EtherNet/IP; 'help' says which words are for it";
    case Fieldbus::kEthercat:
      return "that is a word for EtherNet/IP, and this robot is on EtherCAT; 'help' says which words are for it";
  }
  return {};
}

void apply(const PanelRequest& request, Robot& robot, NetworkFaults* network, PanelAnswer& answer) noexcept {
  const Row& row = row_of(request.word);
  if (row.apply != nullptr) return row.apply(robot, request, answer);
  if (network == nullptr) {
    return refused(answer, "this robot is built into the bridge, there is no network in between; meca-sim has one");
  }
  const std::string_view complaint = misplaced(request, network->bus);
  if (!complaint.empty()) return refused(answer, complaint);
  row.apply_to_network(*network, request, answer);
}

std::string panel_help() {
  std::size_t width = 0;
  for (std::size_t i = 0; i < row_count(); ++i) width = std::max(width, usage(row_of(i)).size());
  std::string text;
  for (const Table& table : kTables) {
    text += table.heading;
    for (const Row& row : table.rows()) {
      const std::string words = usage(row);
      text += words + std::string(width + 2 - words.size(), ' ') + std::string(row.about) + "\n";
    }
  }
  return text;
}

}  // namespace meca::sim
