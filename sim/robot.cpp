#include "sim/robot.hpp"
