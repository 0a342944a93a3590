#include "bridge/config.hpp"
