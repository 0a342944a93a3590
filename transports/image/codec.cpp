#include "transports/image/codec.hpp"
