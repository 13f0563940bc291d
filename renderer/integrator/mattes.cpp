#include "renderer/integrator/mattes.h"

#include <fmt/format.h>

#include <iterator>

#include "renderer/film/cryptomatte.h"

namespace tessera {
namespace {

NameKind kind_of(PassSource source) {
    if (source == PassSource::crypto_object) return NameKind::object;
    return source == PassSource::crypto_material ? NameKind::material : NameKind::asset;
}

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

void add_mattes(const Scene& scene, Film& film, LayeredImage& image,
                std::vector<std::string>& notes) {
    for (std::size_t p = 0; p < film.passes().size(); ++p) {
        const IdCoverage* coverage = film.coverage(p);
        if (!coverage) continue;
        const Pass& pass = film.passes()[p];
        const NameList& list = scene.name_ids()->list(kind_of(pass.source));
        auto layers = cryptomatte_layers(pass.name, *coverage, list.ids, film.sample_counts());
        std::move(layers.begin(), layers.end(), std::back_inserter(image.layers));
        auto header = cryptomatte_header(pass.name, list.names);
        std::move(header.begin(), header.end(), std::back_inserter(image.metadata));
        tell_loss(pass, *coverage, notes);
    }
}

}  // namespace tessera
