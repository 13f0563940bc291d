// Files that appear whole or not at all.
#include "renderer/image/atomic_file.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "renderer/api/error.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("atomic file: of two writers with one pid neither puts the other's half file in place") {
    const TempFolder folder;
    const std::string path = folder / "a.tsf";
    AtomicFile first(path);
    first.write("first", 5);
    first.finish();
    AtomicFile second(path);
    second.write("se", 2);
    CHECK_THROWS_AS(first.commit(), Error);
    CHECK_FALSE(std::filesystem::exists(path));
    second.write("cond", 4);
    second.finish();
    second.commit();
    CHECK(text_of(path) == "second");
}
