#include "materials/displacement.h"

#include <type_traits>

#include "materials/texel.h"

namespace tessera {
namespace {

bool somewhere(const FloatInput& input) { return input.varies() || input.value != 0.0f; }
bool somewhere(const ColorInput& input) { return input.varies() || input.value != Float3{}; }

}  // namespace

bool displaces(const MaterialDesc& desc) {
    const bool scaled = somewhere(desc.displacement) || somewhere(desc.vector_displacement);
    return (scaled && desc.displacement_scale != 0.0f) || desc.displacement_offset != 0.0f;
}

Displacement::Displacement(const MaterialDesc& desc)
    : scale_(desc.displacement_scale),
      offset_(desc.displacement_offset),
      space_(desc.displacement_space),
      moves_(displaces(desc)),
      vector_(somewhere(desc.vector_displacement)) {
    height_ = source_of(desc, desc.displacement);
    direction_ = source_of(desc, desc.vector_displacement);
}

template <class Input>
Displacement::Source Displacement::source_of(const MaterialDesc& desc, const Input& input) {
    Source out;
    out.factor = Vec3f(input.value);
    out.texture = input.texture;
    if constexpr (std::is_same_v<Input, FloatInput>)
        out.channel = input.channel, out.invert = input.invert;
    out.wire.constant = Vec3f(1.0f);
    if (input.node >= 0) out.wire = graph_.add(desc.nodes, input.node, input.output);
    return out;
}

Vec3f Displacement::value(const Source& source, GraphRun& run, const ShadeInput& in,
                          const TextureStore* store) const noexcept {
    if (source.texture < 0) return source.factor * run.value(source.wire);
    const Texel t = store->sample(source.texture, in.uv.x, in.uv.y, in.uv_width);
    if (&source == &direction_) return source.factor * Vec3f{t[0], t[1], t[2]};
    const float height = channel_of(t, source.channel);
    return source.factor * (source.invert ? 1.0f - height : height);
}

Vec3f Displacement::offset(const ShadeInput& in, const Frame& tangent,
                           const TextureStore* store) const noexcept {
    GraphRun run(graph_, in, store);
    const float height = value(height_, run, in, store).x;
    Vec3f out = tangent.n * (scale_ * height + offset_);
    if (!vector_) return out;
    const Vec3f v = value(direction_, run, in, store) * scale_;
    out += space_ == DisplacementSpace::object ? v : tangent.to_world(v);
    return out;
}

}  // namespace tessera
