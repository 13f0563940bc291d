#include "renderer/io/assets.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "renderer/io/obj_text.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 4096;

// Absolute, with symlinks resolved as far as the path exists; empty when that fails.
fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path.empty() ? fs::path(".") : path, error);
    if (error) return {};
    const fs::path real = fs::weakly_canonical(absolute, error);
    return error ? fs::path() : real.lexically_normal();
}

// Both normalised and absolute.
bool is_below(const fs::path& path, const fs::path& folder) {
    const auto [end, unused] =
        std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return end == folder.end() || (end->empty() && std::next(end) == folder.end());
}

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

// The path below base whose parts differ from name's in letter case only; of several, the first by
// name.
fs::path find_any_case(const fs::path& base, const fs::path& name) {
    fs::path at = base;
    for (const fs::path& part : name) {
        std::error_code error;
        if (part == "." || part.empty()) continue;
        if (part == ".." || fs::exists(at / part, error)) {
            at /= part;
            continue;
        }
        const std::string wanted = to_lower(part.string());
        fs::path found;
        for (fs::directory_iterator entry(at, error), end; !error && entry != end;
             entry.increment(error)) {
            const fs::path candidate = entry->path().filename();
            const bool better = found.empty() || candidate < found;
            if (better && to_lower(candidate.string()) == wanted) found = candidate;
        }
        if (found.empty()) return {};
        at /= found;
    }
    return at;
}

bool has_drive(std::string_view name) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return name.size() > 1 && is_letter(name[0]) && name[1] == ':';
}

std::string joined(const std::vector<std::string>& folders) {
    std::string text;
    for (const std::string& folder : folders) text += (text.empty() ? "" : ", ") + folder + "/";
    return text;
}

}  // namespace

AssetRules::AssetRules(const std::string& root, bool allow_external)
    : allow_external_(allow_external) {
    add_root(root);
}

void AssetRules::add_root(const std::string& folder) {
    const std::string real = real_path(folder).string();
    if (!real.empty() && std::find(roots_.begin(), roots_.end(), real) == roots_.end())
        roots_.push_back(real);
}

AssetPath AssetRules::find(const std::string& name, const std::string& base_dir) const {
    std::string text(trim(name));
    if (text.empty()) return {"", "the file name is empty", ""};
    if (text.size() > kLongestName || text.find('\0') != std::string::npos)
        return {"", "not a file name", ""};
    std::replace(text.begin(), text.end(), '\\', '/');

    const auto allowed = [this](const fs::path& path) {
        return allow_external_ ||
               std::any_of(roots_.begin(), roots_.end(),
                           [&](const std::string& root) { return is_below(path, fs::path(root)); });
    };
    bool outside = false;
    const auto probe = [&](const fs::path& candidate) -> std::string {
        const fs::path real = candidate.empty() ? fs::path() : real_path(candidate);
        if (real.empty()) return {};
        if (!allowed(real)) {
            std::error_code error;
            outside = outside || fs::exists(real, error);
            return {};
        }
        return is_file(real) ? real.string() : std::string();
    };

    std::vector<std::string> searched;
    std::vector<fs::path> folders{real_path(base_dir)};
    for (const std::string& root : roots_)
        if (folders.front() != fs::path(root)) folders.emplace_back(root);
    for (const fs::path& folder : folders) searched.push_back(folder.string());

    // Paths of another machine: "C:\tex\a.png" or "/home/x/a.png" fall back to the bare name.
    const bool foreign = has_drive(text) || text.starts_with('/');
    if (foreign && !has_drive(text)) {
        const std::string found = probe(text);
        if (!found.empty()) return {found, "", ""};
    }
    const fs::path wanted =
        foreign ? fs::path(text.substr(text.find_last_of("/:") + 1)) : fs::path(text);
    const bool searchable = !wanted.empty();
    for (const fs::path& folder : folders) {
        if (!searchable) break;
        std::string found = probe(folder / wanted);
        if (!found.empty()) {
            std::string note = foreign ? "found as '" + wanted.string() + "'" : "";
            return {std::move(found), "", std::move(note)};
        }
    }
    if (outside) {
        return {"",
                "lies outside the scene's folders (" + joined(searched) +
                    "); move it there or use --allow-external-assets",
                "", true};
    }
    for (const fs::path& folder : folders) {
        if (!searchable) break;
        const fs::path other = find_any_case(folder, wanted);
        std::string found = probe(other);
        if (found.empty()) continue;
        std::string note =
            "found as '" + other.lexically_relative(folder).string() + "' (letter case differs)";
        return {std::move(found), "", std::move(note)};
    }
    std::error_code error;
    if (searchable && fs::exists(folders.front() / wanted, error) && !error)
        return {"", "is not a regular file", ""};
    return {"", "not found (searched: " + joined(searched) + ")", ""};
}

std::vector<std::string> AssetRules::names_beside(const std::string& name,
                                                  const std::string& base_dir) const {
    std::string text(trim(name));
    std::replace(text.begin(), text.end(), '\\', '/');
    if (text.empty() || text.size() > kLongestName || text.find('\0') != std::string::npos)
        return {};
    const bool foreign = has_drive(text) || text.starts_with('/');
    const fs::path inner = foreign ? fs::path() : fs::path(text).parent_path();
    std::vector<fs::path> folders;
    if (text.starts_with('/')) folders.push_back(fs::path(text).parent_path());
    folders.push_back(real_path(base_dir) / inner);
    for (const std::string& root : roots_) folders.push_back(fs::path(root) / inner);
    for (const fs::path& folder : folders) {
        std::vector<std::string> names;
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error))
            names.push_back(entry->path().filename().string());
        std::sort(names.begin(), names.end());
        if (!names.empty()) return names;
    }
    return {};
}

}  // namespace tessera
