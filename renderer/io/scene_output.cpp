// [output]: how the picture is written.

#include "renderer/io/scene_reader.h"

namespace tessera {
namespace {

const KeySet<OutputDesc>& output_rows() {
    using O = OutputDesc;
    static const KeySet<O> keys{
        {"output",
         {
             choice("exr", &O::exr, {"single", "multipart", "split"},
                    "All layers in one part, each in a part of its own, or each in its own file."),
             choice("compression", &O::compression, {"none", "zips", "zip", "piz", "dwaa", "dwab"},
                    "Of colour; data is kept without loss. dwaa and dwab are lossy."),
             key("dwa_level", &O::dwa_level, "Loss of dwaa and dwab: more is smaller and coarser.",
                 {.low = 0, .high = 1000}),
             key("float", &O::all_float, "Every channel as 32-bit float."),
             key("deep", &O::deep,
                 "Name of a deep EXR to write too, beauty apart by depth: beside the picture, "
                 "unless it has a folder."),
             key("crop_pad", &O::crop_pad,
                 "The file holds the whole frame, black where nothing was rendered."),
             key("deterministic_metadata", &O::deterministic_metadata,
                 "No date, host, time, number of threads or command line in the header."),
         }}};
    return keys;
}

}  // namespace

void read_output(const Value& table, SceneReader& reader) {
    const OutputDesc& output = reader.scene.output;
    read_keys(table, output_rows(), reader.scene.output, {reader.problems, "output"});
    if (!output.deep.empty() && !output.deep.ends_with(".exr"))
        reader.problems.error(table.find("deep")->loc,
                              "output: deep is '" + output.deep + "', must end in .exr");
}

const KeyList& output_keys() { return output_rows().list; }

}  // namespace tessera
