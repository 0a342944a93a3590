// Lines on real Unix sockets: who may have the path, and who is answered what.
#include "transports/net/line_server.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <optional>
#include <vector>

#include "tests/unit/net/temporary_directory.hpp"
#include "transports/net/line_client.hpp"

namespace meca::net {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

constexpr auto kPatience = 60s;  // for a machine that has other things to do

std::string echo(std::string_view line, const std::stop_token&) { return "heard " + std::string(line) + "\n"; }
std::string refuse(std::string_view complaint) { return "no: " + std::string(complaint) + "\n"; }

std::string ask(const fs::path& path, std::string_view line) {
  auto client = LineClient::connect(path);
  if (!client) return "(nobody)";
  return client->ask(line, kPatience).value_or("(no answer)");
}

std::string refusal_to_listen(const fs::path& path) {
  try {
    const UnixListener listener(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "(listens)";
}

// The raw connection, for clients that do not behave.
File connect_raw(const fs::path& path) {
  File socket = std::move(*connect_unix(path));
  ::fcntl(socket.get(), F_SETFL, 0);  // blocking
  return socket;
}
std::string read_to_the_end(const File& socket) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t size = 0; (size = ::read(socket.get(), buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return text;
}
void say(const File& socket, std::string_view bytes) {
  ASSERT_EQ(::send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
}

class Sockets : public testing::Test {
 protected:
  test::TemporaryDirectory directory_;
  const fs::path path_ = directory_ / "a.sock";
};

TEST_F(Sockets, OnlyTheOwnerMayConnect) {
  const UnixListener listener(path_);
  struct stat file {};
  ASSERT_EQ(::stat(path_.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 07777, 0600u);
  EXPECT_TRUE(S_ISSOCK(file.st_mode));
}

TEST_F(Sockets, TheFileGoesWithItsListener) {
  std::optional<UnixListener> listener(std::in_place, path_);
  EXPECT_TRUE(is_listened_on(path_));
  listener.reset();
  EXPECT_FALSE(fs::exists(path_));
  EXPECT_FALSE(is_listened_on(path_));
}

TEST_F(Sockets, ALivingOneKeepsItsPath) {
  const LineServer first(path_, echo, refuse);
  EXPECT_THAT(refusal_to_listen(path_), AllOf(HasSubstr(path_.string()), HasSubstr("in use by another process")));
  EXPECT_EQ(ask(path_, "still there?"), "heard still there?\n");
}

TEST_F(Sockets, ALivingOneKeepsItsPathEvenWhenItIsTooBusyToAccept) {
  const UnixListener busy(path_);
  std::vector<File> waiting;
  while (auto client = connect_unix(path_)) waiting.push_back(std::move(*client));
  EXPECT_GT(waiting.size(), 1u);
  EXPECT_THAT(refusal_to_listen(path_), HasSubstr("in use by another process"));
}

TEST_F(Sockets, ADeadOneIsReplaced) {
  {
    UnixListener killed(path_);
    fs::rename(path_, directory_ / "kept");  // as SIGKILL leaves it: a file that nobody listens on
  }
  fs::rename(directory_ / "kept", path_);
  ASSERT_TRUE(fs::is_socket(path_));
  ASSERT_FALSE(is_listened_on(path_));
  const LineServer server(path_, echo, refuse);
  EXPECT_EQ(ask(path_, "hello"), "heard hello\n");
}

TEST_F(Sockets, AFileOfAnotherKindIsNotTouched) {
  std::ofstream(path_) << "precious";
  EXPECT_THAT(refusal_to_listen(path_), HasSubstr("exists and is not a socket"));
  std::string content;
  std::ifstream(path_) >> content;
  EXPECT_EQ(content, "precious");
}

TEST_F(Sockets, AListenerLeavesAFileAloneThatTookItsPlace) {
  {
    const UnixListener listener(path_);
    fs::remove(path_);
    std::ofstream(path_) << "another's";
  }
  EXPECT_TRUE(fs::is_regular_file(path_));
}

TEST_F(Sockets, PathsThatCannotBeHadAreNamedWithTheReason) {
  const fs::path deep = directory_ / "no such directory" / "a.sock";
  EXPECT_THAT(refusal_to_listen(deep), AllOf(HasSubstr(deep.string()), HasSubstr("No such file or directory")));
  const fs::path longest = directory_ / std::string(kLongestSocketPath - directory_.path().native().size() - 1, 'x');
  EXPECT_EQ(refusal_to_listen(longest), "(listens)");
  EXPECT_THAT(refusal_to_listen(longest.string() + "x"), HasSubstr("has 108 bytes; the path of a socket has 1 to 107"));
  EXPECT_THAT(refusal_to_listen(""), HasSubstr("has 0 bytes"));
}

TEST_F(Sockets, APrivateDirectoryIsMadeOnceAndSharedOnesAreRefused) {
  const fs::path made = directory_ / "made";
  make_private_directory(made);
  make_private_directory(made);
  struct stat file {};
  ASSERT_EQ(::stat(made.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 07777, 0700u);

  fs::permissions(made, fs::perms::all);
  EXPECT_THROW(make_private_directory(made), std::runtime_error);
  fs::create_directory_symlink(directory_.path(), directory_ / "link");
  EXPECT_THROW(make_private_directory(directory_ / "link"), std::runtime_error);
}

TEST_F(Sockets, ClientsAreAnsweredOneAfterAnotherAndAtOnce) {
  const LineServer server(path_, echo, refuse);
  auto first = LineClient::connect(path_), second = LineClient::connect(path_);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->ask("2", kPatience), "heard 2\n");
  EXPECT_EQ(first->ask("1", kPatience), "heard 1\n");
  EXPECT_EQ(second->ask("2 again", kPatience), "heard 2 again\n");
  EXPECT_EQ(ask(path_, "3"), "heard 3\n");
}

TEST_F(Sockets, ManyLinesAtOnceAndOneWithoutItsEndAreAnsweredInOrder) {
  const LineServer server(path_, echo, refuse);
  const File client = connect_raw(path_);
  say(client, "a\nb\nc");
  ::shutdown(client.get(), SHUT_WR);
  EXPECT_EQ(read_to_the_end(client), "heard a\n\nheard b\n\nheard c\n\n");
}

TEST_F(Sockets, BytesThatAreNoTextReachTheAnswerAndTheServerLivesOn) {
  const LineServer server(path_, echo, refuse);
  const std::string noise("\0\xFF\x80\r", 4);
  EXPECT_EQ(ask(path_, noise), "heard " + noise + "\n");
  EXPECT_EQ(ask(path_, "hello"), "heard hello\n");
}

TEST_F(Sockets, ALineThatIsTooLongIsRefusedAndTheNextOneAnswered) {
  const LineServer server(path_, echo, refuse);
  auto client = LineClient::connect(path_);
  ASSERT_TRUE(client);
  EXPECT_EQ(client->ask(std::string(LineServer::kLongestLine, 'x'), kPatience),
            "heard " + std::string(LineServer::kLongestLine, 'x') + "\n");
  EXPECT_EQ(client->ask(std::string(LineServer::kLongestLine + 1, 'x'), kPatience),
            "no: the line has more than 512 bytes\n");
  EXPECT_EQ(client->ask(std::string(100'000, 'x'), kPatience), "no: the line has more than 512 bytes\n");
  EXPECT_EQ(client->ask("hello", kPatience), "heard hello\n");
}

TEST_F(Sockets, AClientThatNeverReadsDoesNotHoldUpTheOthers) {
  const LineServer server(
      path_, [](std::string_view, const std::stop_token&) { return std::string(1 << 20, 'x') + "\n"; }, refuse);
  const File deaf = connect_raw(path_);
  for (int i = 0; i < 3; ++i) say(deaf, "shout\n");
  EXPECT_EQ(ask(path_, "hello").size(), (1u << 20) + 1);
}

TEST_F(Sockets, AClientThatHangsUpAtAnyPointDoesNoHarm) {
  const LineServer server(path_, echo, refuse);
  for (const char* said : {"", "half a line", "line\n", "line\nhalf", "\n\n\n"}) {
    const File client = connect_raw(path_);
    say(client, said);
  }
  EXPECT_EQ(ask(path_, "hello"), "heard hello\n");
}

TEST_F(Sockets, OneClientTooManyIsToldSo) {
  const LineServer server(path_, echo, refuse);
  std::vector<LineClient> clients;
  for (std::size_t i = 0; i < LineServer::kMostClients; ++i) {
    clients.push_back(std::move(*LineClient::connect(path_)));
    EXPECT_EQ(clients.back().ask("hello", kPatience), "heard hello\n");
  }
  EXPECT_EQ(ask(path_, "hello"), "no: 16 clients are connected already; try again later\n");
  EXPECT_EQ(clients.front().ask("still served", kPatience), "heard still served\n");
}

TEST_F(Sockets, AServerThatIsWaitingForItsAnswerCanBeStopped) {
  std::atomic<bool> asked{false};
  std::optional<LineServer> server(
      std::in_place, path_,
      [&asked](std::string_view, const std::stop_token& stop) {
        asked = true;
        while (!stop.stop_requested()) std::this_thread::sleep_for(1ms);
        return std::string("stopped\n");
      },
      refuse);
  const File client = connect_raw(path_);
  say(client, "wait\n");
  while (!asked) std::this_thread::sleep_for(1ms);
  server.reset();
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(Sockets, AClientDoesNotWaitForEverForAServerThatIsSilent) {
  const UnixListener silent(path_);
  auto client = LineClient::connect(path_);
  ASSERT_TRUE(client);
  EXPECT_EQ(client->ask("hello", 50ms), std::nullopt);
}

}  // namespace
}  // namespace meca::net
