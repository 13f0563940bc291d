#pragma once
// The rules that `tessera exrcheck` holds a file to. One entry each; docs/exrcheck.md is made of
// them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tessera {

enum class Severity : std::uint8_t { note, warning, error };
const char* to_string(Severity severity) noexcept;

enum class ExrRule : std::uint8_t {
    unreadable,
    truncated,
    damaged_pixels,
    not_looked_at,
    deep,
    bad_window,
    window_outside_frame,
    window_offset,
    unequal_parts,
    bare_names_in_parts,
    magenta_layer,
    unknown_token,
    long_name,
    many_dots,
    stereo_name,
    leading_digit,
    name_clash,
    half_data,
    lossy_data,
    integer_id,
    no_chromaticities,
    aces_flag,
    nan,
    infinite,
    infinite_depth,
    infinite_lossy,
    negative_colour,
    half_limit,
    alpha_range,
    light_without_alpha,
    normal_length,
    matte_storage,
    matte_metadata,
    matte_key,
    matte_manifest,
    matte_names,
    matte_layers,
    matte_coverage,
    matte_ids,
    sum_of_passes,
    sum_of_lights,
    count,
};

struct ExrRuleText {
    ExrRule rule;
    const char* id;
    Severity severity;
    const char* text;    // what is wrong, and for whom
    const char* remedy;  // what to do
};

std::span<const ExrRuleText> exr_rules() noexcept;
const ExrRuleText& text_of(ExrRule rule) noexcept;
/// docs/exrcheck.md's table.
std::string exr_rules_markdown();

struct ExrFinding {
    ExrRule rule;
    std::string where;  // "channel 'N.X'"
    std::string what;   // "12 values, the first at pixel 3,4"
};
using ExrFindings = std::vector<ExrFinding>;

}  // namespace tessera
