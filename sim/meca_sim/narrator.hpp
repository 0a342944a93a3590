// Tells a person what becomes of a simulated robot and its connection: what happens once, in sentences; the rest in
// numbers at the end.
#pragma once

#include <functional>
#include <string>

#include "sim/robot.hpp"

namespace meca::sim {

class Narrator {
 public:
  enum class Level : std::uint8_t { kInfo, kWarning };
  using Say = std::function<void(Level, const std::string&)>;

  Narrator(const Robot& robot, Say say) : say_(std::move(say)), robot_(robot) {}
  virtual ~Narrator() = default;
  Narrator(const Narrator&) = delete;
  Narrator& operator=(const Narrator&) = delete;

  void look(Time now);  // often: says what has happened since the last look
  std::string summary() const;

 protected:
  virtual void look_at_connection() = 0;
  virtual std::string connection_summary() const = 0;

  Say say_;

 private:
  void look_at_violations(Time now);

  const Robot& robot_;
  bool present_ = true;
  std::uint64_t violations_ = 0;
  Time quiet_until_{};  // violations come in crowds
};

// "3 refused"
inline std::string counted(std::uint64_t count, const char* what) { return std::to_string(count) + " " + what; }

}  // namespace meca::sim
