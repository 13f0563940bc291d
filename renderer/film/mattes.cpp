#include "renderer/film/mattes.h"

#include <fmt/format.h>

#include <iterator>

#include "renderer/film/cryptomatte.h"

namespace tessera {
namespace {

void tell_loss(const Pass& pass, const IdCoverage& coverage, std::vector<std::string>& notes) {
    const CryptomatteLoss loss = cryptomatte_loss(coverage);
    if (loss.crowded_pixels > 0)
        notes.push_back(
            fmt::format("{}: {} pixels see more than {} names, {} samples of the "
                        "smallest are not in the file",
                        pass.name, loss.crowded_pixels, kCryptomatteLevels, loss.crowded_samples));
    if (loss.dropped_pixels > 0)
        notes.push_back(fmt::format(
            "{}: {} pixels see more than {} names, {} samples were not "
            "counted",
            pass.name, loss.dropped_pixels, IdCoverage::kMaxKeys, loss.dropped_samples));
}

}  // namespace

void add_mattes(Film& film, std::span<const std::vector<std::uint32_t>> ids,
                std::vector<Layer>& layers, std::vector<std::string>& notes) {
    for (std::size_t p = 0; p < film.passes().size(); ++p) {
        const IdCoverage* coverage = film.coverage(p);
        if (!coverage) continue;
        const std::string& name = film.passes()[p].name;
        auto added = cryptomatte_layers(name, *coverage, ids[p], film.sample_counts());
        std::move(added.begin(), added.end(), std::back_inserter(layers));
        tell_loss(film.passes()[p], *coverage, notes);
    }
}

}  // namespace tessera
