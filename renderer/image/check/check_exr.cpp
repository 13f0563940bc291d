#include "renderer/image/check/check_exr.h"

#include <algorithm>

#include "renderer/image/check/check_header.h"
#include "renderer/image/check/check_mattes.h"
#include "renderer/image/check/check_sums.h"
#include "renderer/image/check/check_values.h"
#include "renderer/image/check/deep_chunks.h"
#include "renderer/image/check/exr_strips.h"

namespace tessera {
namespace {

bool has(const ExrFindings& findings, ExrRule rule) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const ExrFinding& f) { return f.rule == rule; });
}

void check_pixels(const std::string& path, const RawExr& file, MatteCheck& mattes,
                  ExrFindings& out) {
    if (!fits_to_read(file)) {
        out.push_back(
            {ExrRule::not_looked_at, "file", "more than 2^31 values, or chunks of 256 MiB"});
        return;
    }
    ValueCheck values(file);
    SumCheck sums(file);
    const std::string failure = for_each_strip(path, file, [&](const ExrStripView& strip) {
        values.look(strip);
        mattes.look(strip);
        sums.look(strip);
    });
    if (!failure.empty() && !has(out, ExrRule::truncated))
        out.push_back({ExrRule::damaged_pixels, "file", failure});
    values.tell(out);
    mattes.tell(out);
    if (failure.empty()) sums.tell(out);
}

}  // namespace

ExrFindings check_exr(const std::string& path) {
    ExrFindings out;
    const RawExr file = read_raw_exr(path);
    if (!file.damage.empty()) {
        out.push_back({ExrRule::unreadable, "file", file.damage});
        return out;
    }
    check_windows(file, out);
    check_storage(file, out);
    check_names(file, out);
    MatteCheck mattes(file, out);
    const bool deep = std::any_of(file.parts.begin(), file.parts.end(),
                                  [](const RawPart& part) { return part.deep; });
    if (deep) out.push_back({ExrRule::deep, "file", "it holds deep parts"});
    const RawPart& first = file.parts[0];
    if (first.deep && !first.tiled && !has(out, ExrRule::bad_window) &&
        !has(out, ExrRule::truncated)) {
        const std::string damage = deep_damage(path, file);
        if (!damage.empty()) out.push_back({ExrRule::damaged_pixels, "file", damage});
    }
    if (!has(out, ExrRule::bad_window) && !file.parts[0].deep)
        check_pixels(path, file, mattes, out);
    std::stable_sort(out.begin(), out.end(), [](const ExrFinding& a, const ExrFinding& b) {
        return text_of(a.rule).severity > text_of(b.rule).severity;
    });
    return out;
}

}  // namespace tessera
