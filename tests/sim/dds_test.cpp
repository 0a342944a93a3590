// The DDS wrapper between two participants of this process: what every other part takes for granted.
#include "bridge/dds.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>

#include "e2e.hpp"
#include "idl/types.hpp"

namespace meca::test {
namespace {

using dds::Durability;
using dds::Participant;
using dds::Qos;
using dds::Reliability;

const Qos kState{.durability = Durability::kTransientLocal};

meca500::TargetJointSet joints(const std::string& robot, std::uint64_t cycle) {
  meca500::TargetJointSet sample;
  sample.robot(robot);
  sample.header().cycle(cycle);
  sample.joints()[5] = 12.5F;
  return sample;
}

TEST(Dds, ALateJoinerGetsTheLastSampleOfEveryInstanceAndKnowsWhoWroteIt) {
  Participant bridge(local(kDdsDomain, "bridge"));
  auto writer = bridge.create_writer<meca500::TargetJointSet>("t/late", kState);
  constexpr int kRobots = 65;  // more than the vendor's default limits of 10 instances, and of 64 robots
  for (int i = 0; i < kRobots; ++i) {
    ASSERT_TRUE(writer.write(joints("arm" + std::to_string(i), 1)));
    ASSERT_TRUE(writer.write(joints("arm" + std::to_string(i), 2)));
  }
  Participant client(local(kDdsDomain, "client"));
  auto reader = client.create_reader<meca500::TargetJointSet>("t/late", kState);
  std::set<std::string> robots;
  meca500::TargetJointSet sample;
  dds::SampleInfo info;
  EXPECT_TRUE(eventually([&] {
    client.wait_for_data(kPoll);
    while (reader.take(sample, info)) {
      EXPECT_TRUE(info.valid_data);
      EXPECT_EQ(info.participant, bridge.id());
      EXPECT_GT(info.source_time_ns, 1'600'000'000'000'000'000);
      EXPECT_EQ(sample.header().cycle(), 2U);
      EXPECT_EQ(sample.joints()[5], 12.5F);
      robots.insert(sample.robot().to_string());
    }
    return robots.size() == kRobots;
  })) << robots.size();
}

TEST(Dds, ABestEffortReaderMatchesAReliableWriter) {
  Participant bridge(local(kDdsDomain, "bridge"));
  Participant client(local(kDdsDomain, "client"));
  auto writer = bridge.create_writer<meca500::TargetJointSet>("t/best", kState);
  auto reader = client.create_reader<meca500::TargetJointSet>("t/best", {.reliability = Reliability::kBestEffort});
  EXPECT_TRUE(eventually([&] { return writer.matched() == 1 && reader.matched() == 1; }));
}

TEST(Dds, KeepAllCommandsArriveInOrderAndAWaitSeesWhatAnEarlierTakeLeft) {
  Participant bridge(local(kDdsDomain, "bridge"));
  Participant client(local(kDdsDomain, "client"));
  const Qos qos{.depth = 0, .max_samples = 64};
  auto reader = bridge.create_reader<meca500::Command>("t/cmd", {.depth = 0, .max_samples = 64, .max_instances = 4});
  auto writer = client.create_writer<meca500::Command>("t/cmd", qos);
  ASSERT_TRUE(eventually([&] { return writer.matched() == 1 && reader.matched() == 1; }));
  meca500::Command command;
  command.robot("arm1");
  command.client("test");
  command.arguments({1, 2, 3});
  for (std::uint64_t id = 1; id <= 20; ++id) {
    command.command_id(id);
    ASSERT_TRUE(writer.write(command));
  }
  dds::SampleInfo info;
  meca500::Command got;
  for (std::uint64_t id = 1; id <= 20; ++id) {
    ASSERT_TRUE(eventually([&] { return bridge.wait_for_data(kPoll); }));  // one take per wait
    ASSERT_TRUE(reader.take(got, info));
    ASSERT_TRUE(info.valid_data);
    EXPECT_EQ(got.command_id(), id);
    EXPECT_EQ(got.arguments().size(), 3U);
    EXPECT_EQ(info.participant, client.id());
  }
  EXPECT_FALSE(reader.take(got, info));
  EXPECT_FALSE(bridge.wait_for_data(std::chrono::milliseconds(1)));
}

TEST(Dds, AParticipantWithoutSharedMemoryReachesOneWithIt) {
  auto udp = local(kDdsDomain, "udp");
  udp.shared_memory = false;
  Participant container(udp);
  Participant host(local(kDdsDomain, "host"));
  auto writer = container.create_writer<meca500::TargetJointSet>("t/udp", kState);
  auto reader = host.create_reader<meca500::TargetJointSet>("t/udp", kState);
  ASSERT_TRUE(writer.write(joints("arm1", 7)));
  meca500::TargetJointSet sample;
  dds::SampleInfo info;
  EXPECT_TRUE(eventually([&] { return host.wait_for_data(kPoll) && reader.take(sample, info); }));
  EXPECT_EQ(sample.header().cycle(), 7U);
}

TEST(Dds, AWriterOutlivesTheVariableOfItsParticipantSafely) {
  auto participant = std::make_unique<Participant>(local(kDdsDomain, "short"));
  auto writer = participant->create_writer<meca500::TargetJointSet>("t/order", kState);
  participant.reset();
  EXPECT_TRUE(writer.write(joints("arm1", 1)));
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const dds::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Dds, MistakesAreSentences) {
  EXPECT_EQ(error_of([] { Participant p(local(233, "x")); }), "DDS domain 233 does not exist; use 0 to 232");
  EXPECT_THAT(error_of([] {
                auto options = local(kDdsDomain, "x");
                options.interfaces = {"192.0.2.1"};
                Participant p(options);
              }),
              testing::HasSubstr("192.0.2.1 is not an IPv4 address of this machine; it has 127.0.0.1"));
  Participant p(local(kDdsDomain, "types"));
  auto writer = p.create_writer<meca500::TargetJointSet>("t/type", kState);
  EXPECT_EQ(error_of([&] { (void)p.create_reader<meca500::Command>("t/type", {}); }),
            "DDS topic 't/type' already has the type meca500::TargetJointSet, not meca500::Command");
}

}  // namespace
}  // namespace meca::test
