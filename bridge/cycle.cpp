#include "bridge/cycle.hpp"
