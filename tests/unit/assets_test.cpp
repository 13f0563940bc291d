#include "renderer/io/assets.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/support/obj_files.h"

namespace tessera::test {
namespace {

// scene/ is the root; secret.png lies outside.
struct Tree {
    ObjFiles files;
    Tree() {
        files.write("scene/geo/a.obj", "x");
        files.write("scene/tex/Wood.PNG", "x");
        files.write("scene/top.png", "x");
        files.write("secret.png", "x");
    }
    std::string root() const { return files.path("scene"); }
    std::string geo() const { return files.path("scene/geo"); }
    AssetPath find(const std::string& name, bool external = false) const {
        return AssetRules(root(), external).find(name, geo());
    }
};

}  // namespace

TEST_CASE("assets: a name is looked up beside the file that names it, then in the root") {
    const Tree tree;
    CHECK(tree.find("a.obj").path.ends_with("scene/geo/a.obj"));
    CHECK(tree.find("top.png").path.ends_with("scene/top.png"));
    CHECK(tree.find("../tex/Wood.PNG").path.ends_with("scene/tex/Wood.PNG"));
    const AssetPath missing = tree.find("none.png");
    CHECK(missing.path == "");
    CHECK(missing.reason.starts_with("not found (searched: "));
    CHECK_FALSE(missing.refused);
}

TEST_CASE("assets: backslashes and other letter case are mended, the latter with a note") {
    const Tree tree;
    CHECK(tree.find("..\\tex\\Wood.PNG").path.ends_with("scene/tex/Wood.PNG"));
    const AssetPath found = tree.find("../TEX/wood.png");
    CHECK(found.path.ends_with("scene/tex/Wood.PNG"));
    CHECK(found.note.find("letter case differs") != std::string::npos);
}

TEST_CASE("assets: paths of another machine fall back to the file name") {
    const Tree tree;
    for (const std::string name : {"C:\\work\\tex\\top.png", "c:/top.png", "/home/nobody/top.png",
                                   "\\\\server\\share\\top.png"}) {
        CAPTURE(name);
        CHECK(tree.find(name).path.ends_with("scene/top.png"));
        CHECK(tree.find(name).note.find("top.png") != std::string::npos);
    }
}

TEST_CASE("assets: what lies outside is refused, unless external assets are allowed") {
    const Tree tree;
    for (const std::string& name :
         {std::string("../../secret.png"), tree.files.path("secret.png")}) {
        const AssetPath found = tree.find(name);
        CHECK(found.path == "");
        CHECK(found.refused);
        CHECK(found.reason.find("--allow-external-assets") != std::string::npos);
        CHECK(tree.find(name, true).path.ends_with("secret.png"));
    }
}

TEST_CASE("assets: a symlink that leaves the folders is refused") {
    const Tree tree;
    std::filesystem::create_symlink(tree.files.path("secret.png"),
                                    tree.files.path("scene/geo/link.png"));
    std::filesystem::create_directory_symlink(tree.files.path(""), tree.files.path("scene/geo/up"));
    CHECK(tree.find("link.png").refused);
    CHECK(tree.find("up/secret.png").refused);
}

TEST_CASE("assets: a folder whose name begins like the root's is outside") {
    const Tree tree;
    tree.files.write("scenery/x.png", "x");
    CHECK(tree.find("../../scenery/x.png").refused);
}

TEST_CASE("assets: an added root counts as inside") {
    const Tree tree;
    AssetRules rules(tree.geo(), false);
    CHECK(rules.find("../top.png", tree.geo()).refused);
    rules.add_root(tree.root());
    CHECK_FALSE(rules.find("../top.png", tree.geo()).path.empty());
}

TEST_CASE("assets: only regular files are found") {
    const Tree tree;
    REQUIRE(::mkfifo(tree.files.path("scene/geo/pipe.png").c_str(), 0600) == 0);
    CHECK(tree.find("pipe.png").reason == "is not a regular file");
    CHECK(tree.find("../tex").path == "");
    for (const std::string name : {"", " ", "..", "/", "C:\\", "a\nb", "/dev/zero"}) {
        CAPTURE(name);
        CHECK(tree.find(name, true).path == "");
    }
    CHECK(tree.find(std::string(100000, 'a')).path == "");
    CHECK(tree.find(std::string("a\0b", 3)).path == "");
}

}  // namespace tessera::test
