#include "bridge/control/messages.hpp"
