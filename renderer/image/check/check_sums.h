#pragma once
// Whether passes and light groups sum to beauty.

#include <string>
#include <vector>

#include "renderer/image/check/channel_sets.h"
#include "renderer/image/check/check_values.h"

namespace tessera {

class SumCheck {
public:
    explicit SumCheck(const RawExr& file);
    void look(const ExrStripView& strip);
    void tell(ExrFindings& out) const;

private:
    struct Sum {
        ExrRule rule;
        std::string names;  // "diffuse + specular"
        std::vector<ChannelSet> terms;
        Tally tally;
        std::uint64_t pixels = 0;
        float worst = 0;  // relative to what was added
    };
    void add_passes(const RawExr& file);
    void add_lights(const RawExr& file);
    void look(const ExrStripView& strip, Sum& sum) const;

    std::optional<ChannelSet> beauty_;
    std::vector<Sum> sums_;
};

}  // namespace tessera
