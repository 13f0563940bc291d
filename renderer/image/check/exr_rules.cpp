#include "renderer/image/check/exr_rules.h"

#include <array>

namespace tessera {
namespace {

using enum Severity;
using R = ExrRule;

constexpr std::array<ExrRuleText, static_cast<std::size_t>(R::count)> kRules{{
    {R::unreadable, "unreadable", error, "The file is not OpenEXR, or its header is damaged.",
     "Write it again; if it was copied, copy it again."},
    {R::truncated, "truncated", error,
     "Pixels are missing: the writer was stopped or the disk was full.",
     "Render or copy the frame again."},
    {R::damaged_pixels, "damaged-pixels", error, "The pixels cannot be decoded.",
     "Render or copy the frame again."},
    {R::not_looked_at, "not-looked-at", warning,
     "The picture is larger than what is checked; only its header was.",
     "Check a smaller frame of the same kind."},
    {R::deep, "deep", note,
     "Deep samples are not looked at; only the header and what lies where was.",
     "Flatten the file and check that as well."},
    {R::bad_window, "bad-window", error, "The data or display window is empty or out of range.",
     "Write windows with min <= max."},
    {R::window_outside_frame, "window-outside-frame", warning,
     "The data window does not touch the display window: the frame shows nothing.",
     "Check the crop and the resolution of the writer."},
    {R::window_offset, "window-offset", warning,
     "The data window is not the frame. Blender ignores the offset and shows the window as a frame "
     "of its own size.",
     "For such readers pad the frame (tessera render --crop-pad) or leave overscan out."},
    {R::unequal_parts, "unequal-parts", warning,
     "Parts have different windows; many readers take the first part's for all.",
     "Give all parts one window."},
    {R::bare_names_in_parts, "bare-names-in-parts", error,
     "Several parts have channels without a layer's name. Blender 3.4 mixes them up and crashes.",
     "Name channels layer.C in all parts but the first."},
    {R::magenta_layer, "magenta-layer", warning,
     "A layer of 2 channels, or of more than 4, is magenta in Blender.",
     "Write 1, 3 or 4 channels a layer (motion as X Y Z W, uv as U V A)."},
    {R::unknown_token, "unknown-token", warning,
     "Blender drops channels whose last word is none of R G B A X Y Z W U V.",
     "Rename the channel, for example samples.A or id.X."},
    {R::long_name, "long-name", warning,
     "A name of more than 31 characters: older readers refuse the file, Blender loses the layer.",
     "Shorten it to 31 characters, layer and channel together."},
    {R::many_dots, "many-dots", warning,
     "A name with more than one dot before the channel: readers cut it into layer and pass, or "
     "lose it.",
     "Use layer.C; write what was nested with an underscore."},
    {R::stereo_name, "stereo-name", warning,
     "Nuke takes a name that begins or ends with left or right for a view of a stereo pair.",
     "Use another word, for example key_l."},
    {R::leading_digit, "leading-digit", warning, "Nuke strips digits from the start of names.",
     "Begin the name with a letter."},
    {R::name_clash, "name-clash", warning,
     "Two layers differ only in characters that Nuke replaces by an underscore.",
     "Use letters, digits and underscores only."},
    {R::half_data, "half-data", warning,
     "Data (depth, position, normals, motion, ids, variance) is stored as half: 11 bits, nothing "
     "beyond 65504.",
     "Write it as float."},
    {R::lossy_data, "lossy-data", error, "Data is stored with a lossy codec, which changes it.",
     "Write data with ZIP, ZIPS or PIZ; put it in a part or a file of its own."},
    {R::integer_id, "integer-id", note,
     "Most readers turn integer channels into floats, which are exact to 16777216 only.",
     "Keep ids below that, or use Cryptomatte."},
    {R::no_chromaticities, "no-chromaticities", note,
     "The header does not say what the primaries are; readers take Rec. 709.",
     "Write the chromaticities attribute."},
    {R::aces_flag, "aces-flag", error,
     "acesImageContainerFlag promises an uncompressed RGB(A) picture in AP0 and nothing else "
     "(ST 2065-4).",
     "Remove the attribute from files that have layers, a codec or other primaries."},
    {R::nan, "nan", error, "Values that are no number spread to everything that filters them.",
     "Find the material or light that makes them; fill the pixels (oiiotool --fixnan)."},
    {R::infinite, "infinite", error, "Infinite values spread to everything that filters them.",
     "Clamp before writing, or write float in place of half."},
    {R::infinite_depth, "infinite-depth", warning,
     "Infinite depth breaks defocus, fog and every filter.",
     "Write a large number where nothing is hit, for example 1e10."},
    {R::infinite_lossy, "infinite-lossy", error,
     "An infinite value under DWA spoils its whole block of 8x8 pixels.",
     "Clamp to 16384 before writing with DWA, or use ZIP."},
    {R::negative_colour, "negative-colour", warning,
     "Negative colours turn up as black dots or wrong hues after grading.",
     "Clamp, or choose working primaries that hold the colours."},
    {R::half_limit, "half-limit", note, "Values at half's end, 65504: something was clamped there.",
     "Write float (tessera render --float) if the peaks matter."},
    {R::alpha_range, "alpha-range", warning, "Alpha outside 0 to 1.",
     "Use a pixel filter without negative lobes, or clamp."},
    {R::light_without_alpha, "light-without-alpha", note,
     "Colour where alpha is 0. That is legal (glow, background) and is lost by tools that "
     "un-premultiply.",
     "Add the picture over others; never un-premultiply it."},
    {R::normal_length, "normal-length", warning,
     "Normals are not of unit length (shorter ones at edges are usual).",
     "Write world or camera normals from -1 to 1, not scaled to 0..1."},
    {R::matte_storage, "matte-storage", error,
     "Cryptomatte works only as lossless 32-bit float; otherwise every matte is silently empty.",
     "Write it as float with ZIP, ZIPS or PIZ."},
    {R::matte_metadata, "matte-metadata", error,
     "Cryptomatte's header entries are incomplete or unknown.",
     "Write cryptomatte/KEY/name, hash (MurmurHash3_32), conversion (uint32_to_float32) and "
     "manifest."},
    {R::matte_key, "matte-key", warning,
     "The key of Cryptomatte's entries is not the first 7 hex digits of the hashed layer name.",
     "Derive it from the layer's name; it must differ between layers."},
    {R::matte_manifest, "matte-manifest", error,
     "Cryptomatte's manifest is no JSON object of names and 8 hex digits.",
     "Escape names as JSON and write ids as 8 lower-case hex digits."},
    {R::matte_names, "matte-names", warning, "Names in the manifest do not hash to their ids.",
     "Hash the UTF-8 bytes of the name with seed 0 and adjust the exponent as the specification "
     "says."},
    {R::matte_layers, "matte-layers", error,
     "Cryptomatte's header and layers do not fit: NAME00, NAME01 ... of R G B A are expected.",
     "Write the ranks from 00 on without gaps, four channels each."},
    {R::matte_coverage, "matte-coverage", warning,
     "Coverages of a pixel sum to more than 1, or one is negative.",
     "Divide by the sum of the filter's weights; use a filter without negative lobes."},
    {R::matte_ids, "matte-ids", warning, "Pixels hold ids that the manifest does not name.",
     "List every object in the manifest; never filter or resize the ids."},
    {R::sum_of_passes, "sum-of-passes", warning, "The passes of light do not sum to beauty.",
     "Write all of them, before clamping and denoising, in one working space."},
    {R::sum_of_lights, "sum-of-lights", warning, "The light groups do not sum to beauty.",
     "Write all groups and one for the rest, clamp by one factor."},
}};

constexpr bool in_order() {
    for (std::size_t i = 0; i < kRules.size(); ++i)
        if (static_cast<std::size_t>(kRules[i].rule) != i) return false;
    return true;
}
static_assert(in_order(), "the table is indexed by the rule");

}  // namespace

const char* to_string(Severity severity) noexcept {
    return severity == error ? "error" : severity == warning ? "warning" : "note";
}

std::span<const ExrRuleText> exr_rules() noexcept { return kRules; }

const ExrRuleText& text_of(ExrRule rule) noexcept { return kRules[static_cast<std::size_t>(rule)]; }

std::string exr_rules_markdown() {
    std::string out = "| rule | severity | what it means | what to do |\n|---|---|---|---|\n";
    for (const ExrRuleText& r : kRules) {
        out += std::string("| `") + r.id + "` | " + to_string(r.severity) + " | " + r.text + " | " +
               r.remedy + " |\n";
    }
    return out;
}

}  // namespace tessera
