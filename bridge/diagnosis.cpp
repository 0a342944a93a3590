#include "bridge/diagnosis.hpp"
