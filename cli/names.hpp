// IDL enums as the words of the IDL.
#pragma once

#include <string_view>

#include "idl/types.hpp"

namespace meca::cli {

// "?" for a number this version does not know: a newer bridge may be on the other end.
std::string_view name(meca500::Quality value);
std::string_view name(meca500::LinkState value);
std::string_view name(meca500::ReceiptState value);
std::string_view name(meca500::ReceiptReason value);
std::string_view name(meca500::LossPolicy value);

bool is_terminal(meca500::ReceiptState state);

}  // namespace meca::cli
