#include "bridge/dds.hpp"
