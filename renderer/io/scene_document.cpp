#include "renderer/io/scene_document.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "renderer/io/scene_parse.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t(64) << 20;
constexpr std::size_t kMaxIncludeDepth = 16;
constexpr std::size_t kMaxIncludes = 1000;

std::string read_text(const std::string& path, const SourceLoc& from) {
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (!fs::exists(status)) throw Error(ExitCode::scene, from, "'" + path + "' not found");
    if (!fs::is_regular_file(status))
        throw Error(ExitCode::scene, from, "'" + path + "' is not a regular file");
    const std::uintmax_t size = fs::file_size(path, failed);
    if (!failed && size > kMaxBytes) {
        const std::string mib = std::to_string(size >> 20);
        throw Error(ExitCode::scene, from,
                    "'" + path + "' has " + mib + " MiB, a scene file has at most 64");
    }
    std::ifstream in(path, std::ios::binary);
    std::string text(failed ? 0 : size, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (failed || !in) throw Error(ExitCode::scene, from, "'" + path + "' cannot be read");
    return text;
}

/// Lays over upon under: tables key by key, [[tables]] joined, anything else replaced.
void merge(Value& under, Value&& over) {
    auto* below = std::get_if<Table>(&under.data);
    auto* above = std::get_if<Table>(&over.data);
    if (below && above) {
        for (auto& [key, value] : *above) {
            const auto found = below->find(key);
            if (found == below->end()) {
                below->emplace(key, std::move(value));
            } else {
                merge(found->second, std::move(value));
            }
        }
        under.loc = over.loc;
        return;
    }
    auto* first = std::get_if<List>(&under.data);
    auto* second = std::get_if<List>(&over.data);
    const auto of_tables = [](const List* list) {
        return list && !list->empty() && list->front().table();
    };
    if (of_tables(first) && of_tables(second)) {
        std::move(second->begin(), second->end(), std::back_inserter(*first));
        return;
    }
    under = std::move(over);
}

/// Puts the texts of a list of the document below in front of those of the one above.
void join_texts(const Value& under, Value& over, const char* key) {
    const Value* first = under.find(key);
    auto* table = std::get_if<Table>(&over.data);
    const auto second = table ? table->find(key) : Table::iterator();
    if (!first || !first->list() || !table || second == table->end()) return;
    if (auto* list = std::get_if<List>(&second->second.data))
        list->insert(list->begin(), first->list()->begin(), first->list()->end());
}

class DocumentReader {
public:
    DocumentReader(const AssetRules& assets, std::vector<std::string>& files)
        : assets_(assets), files_(files) {}

    Value read(const std::string& path, const SourceLoc& from) {
        std::error_code failed;
        const std::string identity = fs::weakly_canonical(path, failed).string();
        if (std::find(open_.begin(), open_.end(), identity) != open_.end()) {
            throw Error(ExitCode::scene, from,
                        "include of '" + path + "', which includes this file");
        }
        if (open_.size() >= kMaxIncludeDepth)
            throw Error(ExitCode::scene, from, "includes nested deeper than 16");
        if (!seen_.insert(identity).second) return {Table{}, from};
        if (seen_.size() > kMaxIncludes)
            throw Error(ExitCode::scene, from, "more than 1000 included files");
        open_.push_back(identity);
        Value own = parse_toml(read_text(path, from), path);
        files_.push_back(path);
        Value whole{Table{}, own.loc};
        for (const Value& name : includes(own)) merge(whole, read(resolve(name), name.loc));
        join_texts(whole, own, "materialx");
        merge(whole, std::move(own));
        open_.pop_back();
        return whole;
    }

private:
    static List includes(const Value& document) {
        const Value* include = document.find("include");
        if (!include) return {};
        const auto is_text = [](const Value& value) { return value.text() != nullptr; };
        const List* list = include->list();
        if (!list || !std::all_of(list->begin(), list->end(), is_text)) {
            const std::string shown = describe(*include);
            throw Error(ExitCode::scene, include->loc,
                        "include is " + shown + ", must be texts in brackets");
        }
        return *list;
    }

    std::string resolve(const Value& name) const {
        const AssetPath found = assets_.find(*name.text(), folder_of(name.loc, ""));
        if (!found.path.empty()) return found.path;
        throw Error(ExitCode::scene, name.loc,
                    "include: file '" + *name.text() + "' " + found.reason);
    }

    const AssetRules& assets_;
    std::vector<std::string>& files_;
    std::vector<std::string> open_;
    std::set<std::string> seen_;
};

}  // namespace

Value read_document(const std::string& path, const AssetRules& assets,
                    std::vector<std::string>& files) {
    const SourceLoc nowhere;
    return DocumentReader(assets, files).read(path, nowhere);
}

std::string folder_of(const SourceLoc& loc, const std::string& root) {
    if (loc.line == 0 || !loc.file) return root;
    const std::string folder = fs::path(*loc.file).parent_path().string();
    return folder.empty() ? "." : folder;
}

}  // namespace tessera
