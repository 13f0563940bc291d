#pragma once
// Which files a scene may read, and how a name in a file becomes a path.

#include <string>
#include <vector>

namespace tessera {

/// The outcome of a look-up: path is empty when nothing may be read, and reason says why.
struct AssetPath {
    std::string path;
    std::string reason;  // "not found (searched: a/, b/)", "lies outside the scene's folders ..."
    std::string note;    // e.g. "found as 'M.MTL' (letter case differs)"
    bool refused =
        false;  // there is such a file, but outside the scene's folders: an error, not a warning
};

class AssetRules {
public:
    /// root: the folder of the scene file; assets lie in it or below it unless allow_external.
    AssetRules(const std::string& root, bool allow_external);

    /// Adds a folder that assets may lie in (for an OBJ named on the command line, its own folder).
    void add_root(const std::string& folder);

    /// name as written in a file in base_dir: '\' counts as '/', "C:\..." falls back to the file
    /// name, letter case falls back to a case-insensitive search. Symlinks are resolved before the
    /// check. Only regular files are found.
    AssetPath find(const std::string& name, const std::string& base_dir) const;

    /// The names of all that lies in the folder that `name` points into, sorted; of several folders
    /// that find() would search, the first that is there. Says nothing of what may be read.
    std::vector<std::string> names_beside(const std::string& name,
                                          const std::string& base_dir) const;

private:
    std::vector<std::string> roots_;
    bool allow_external_ = false;
};

}  // namespace tessera
