// What a robot does about an event (spec 3.3); which of them a command takes is in Table 8.
#pragma once

namespace meca::sim::severity {

// Nothing; its status bit; motion pauses too; or it is an error too.
inline constexpr int kSilent = 0, kWarning = 1, kPause = 2, kError = 4;

}  // namespace meca::sim::severity
