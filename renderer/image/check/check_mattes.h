#pragma once
// Cryptomatte 1.2.0: header entries, layers, ids and coverages.

#include <set>
#include <string>
#include <vector>

#include "renderer/image/check/channel_sets.h"
#include "renderer/image/check/check_values.h"

namespace tessera {

class MatteCheck {
public:
    /// Tells at once what the header alone shows.
    MatteCheck(const RawExr& file, ExrFindings& out);
    void look(const ExrStripView& strip);
    void tell(ExrFindings& out) const;

private:
    struct Matte {
        std::string name;               // "CryptoObject"
        std::vector<ChannelSet> ranks;  // R G B A of 00, 01 ...
        std::set<std::uint32_t> ids;    // of the manifest
        bool named = false;             // there is a manifest to compare with
        Tally coverage, unknown;
    };
    static void look(const ExrStripView& strip, Matte& matte);

    std::vector<Matte> mattes_;
};

}  // namespace tessera
