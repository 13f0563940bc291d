#pragma once
// Texts and bytes as the files of a report need them.

#include <string>
#include <string_view>

namespace tessera {

/// For HTML and XML, in text and in attributes; what is no UTF-8, and control characters, become
/// something that is allowed there.
std::string escaped(std::string_view text);

/// JSON as it may stand in a <script>: no '<', which could end it.
std::string inside_script(std::string_view json);

/// A field of a CSV file (RFC 4180): in quotes where it must be.
std::string csv_field(std::string_view text);

std::string base64(std::string_view bytes);

/// Three figures: "0.00123", "12.3", "1.2e-7"; "-" for what is no number.
std::string three_figures(double v);

/// "0.12 s", "3.4 s", "74 min", "2.1 h"
std::string duration(double seconds);

/// "12.3 k", "4.56 M"
std::string with_prefix(double v);

}  // namespace tessera
