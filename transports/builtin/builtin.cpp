#include "transports/builtin/builtin.hpp"
