// The fingerprint of a scene: what is in its files, not where they lie.
#include <doctest/doctest.h>

#include "renderer/scene/file_hash.h"
#include "renderer/scene/hash.h"
#include "tests/support/map_files.h"
#include "tests/support/scene_folder.h"

using namespace tessera;

TEST_CASE("scene hash: the same scene in another folder has it, another image in its place not") {
    const auto hash_of = [](Color color) {
        SceneFolder folder;
        write_map(folder.path("map.exr"), color);
        return scene_hash(folder.load("[environment]\nfile = 'map.exr'\n[[sphere]]\n"));
    };
    CHECK(hash_of(Color{0.5f, 0.25f, 1.0f}) == hash_of(Color{0.5f, 0.25f, 1.0f}));
    CHECK(hash_of(Color{0.5f, 0.25f, 1.0f}) != hash_of(Color{0.5f, 0.25f, 0.5f}));
}

TEST_CASE("scene hash: of a large file the size, both ends and pieces between them count") {
    SceneFolder folder;
    std::string bytes(20 << 20, 'a');
    const std::string path = folder.write("large", bytes);
    const std::uint64_t whole = file_hash(path);
    CHECK(file_hash(folder.write("copy", bytes)) == whole);
    for (const std::size_t at : {std::size_t{0}, bytes.size() - 1}) {
        bytes[at] = 'b';
        CHECK(file_hash(folder.write("large", bytes)) != whole);
        bytes[at] = 'a';
    }
    CHECK(file_hash(folder.write("large", bytes + "a")) != whole);
    CHECK(file_hash(folder.path("none")) == 0);
    CHECK(file_hash(folder.path("")) == 0);  // a folder
    CHECK(file_hash(folder.write("empty", "")) != 0);
}
