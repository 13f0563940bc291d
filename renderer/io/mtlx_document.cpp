#include "renderer/io/mtlx_document.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <pugixml.hpp>
#include <set>

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t(64) << 20;
constexpr std::size_t kMaxElements = 200'000, kMaxAttributes = 256;
constexpr int kMaxNesting = 64;
constexpr std::size_t kMaxIncludeDepth = 16;

std::string read_text(const std::string& path, const SourceLoc& from) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (!failed && size > kMaxBytes)
        throw Error(ExitCode::scene, from,
                    "'" + path + "' has " + std::to_string(size >> 20) +
                        " MiB, a MaterialX document has at most 64");
    std::ifstream in(path, std::ios::binary);
    std::string text(failed ? 0 : size, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (failed || !in) throw Error(ExitCode::scene, from, "'" + path + "' cannot be read");
    return text;
}

/// Lines and columns of one file, by offset.
class Places {
public:
    Places(const std::string& text, const std::string& path)
        : file_(std::make_shared<const std::string>(path)) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') starts_.push_back(i + 1);
    }
    SourceLoc at(std::size_t offset) const {
        const auto line = std::upper_bound(starts_.begin(), starts_.end(), offset) - 1;
        return {file_, static_cast<int>(line - starts_.begin()) + 1,
                static_cast<int>(offset - *line) + 1};
    }

private:
    std::shared_ptr<const std::string> file_;
    std::vector<std::size_t> starts_{0};
};

std::string lowered(std::string text) {
    if (!text.empty())
        text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    return text;
}

// Documents before 1.38 call these otherwise.
std::string category_of(const char* name) {
    const std::string_view text = name;
    return text == "parameter" || text == "bindinput" ? "input" : std::string(text);
}

}  // namespace

/// Reads files into one document.
class MtlxParser {
public:
    MtlxParser(MtlxDocument& document, SceneReader& reader)
        : document_(document), reader_(reader) {}

    void read(const std::string& path, const SourceLoc& from) {
        if (std::find(open_.begin(), open_.end(), path) != open_.end())
            throw Error(ExitCode::scene, from,
                        "include of '" + path + "', which includes this file");
        if (open_.size() >= kMaxIncludeDepth)
            throw Error(ExitCode::scene, from, "includes nested deeper than 16");
        if (!seen_.insert(path).second) return;
        open_.push_back(path);
        std::string text = read_text(path, from);
        const Places places(text, path);
        reader_.add_file(path);
        pugi::xml_document xml;
        const auto result =
            xml.load_buffer_inplace(text.data(), text.size(),
                                    pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
        const auto place = [&](const char* inside) {
            const auto offset = static_cast<std::size_t>(inside - text.data());
            return places.at(offset > 0 ? offset - 1 : 0);
        };
        if (!result)
            throw Error(ExitCode::scene, places.at(static_cast<std::size_t>(result.offset)),
                        "no valid XML: " + lowered(result.description()));
        for (const pugi::xml_node node : xml.children())
            if (node.type() == pugi::node_doctype)
                throw Error(ExitCode::scene, places.at(0),
                            "a document type is not allowed in a MaterialX document");
        const pugi::xml_node root = xml.document_element();
        if (std::string_view(root.name()) != "materialx")
            throw Error(
                ExitCode::scene, place(root.name()),
                "the outermost element is '" + std::string(root.name()) + "', must be 'materialx'");
        const auto convert = [&](const auto& self, const pugi::xml_node& node,
                                 const MtlxElement* parent, int depth) -> const MtlxElement* {
            const SourceLoc loc = place(node.name());
            if (depth > kMaxNesting)
                throw Error(ExitCode::scene, loc, "elements nested deeper than 64");
            if (document_.elements_.size() >= kMaxElements)
                throw Error(ExitCode::scene, loc, "more than 200 000 elements");
            MtlxElement& element = document_.elements_.emplace_back();
            element.category = category_of(node.name());
            element.loc = loc;
            element.parent = parent;
            for (const pugi::xml_attribute a : node.attributes()) {
                if (element.attributes.size() >= kMaxAttributes)
                    throw Error(ExitCode::scene, loc, "more than 256 attributes");
                element.attributes.emplace_back(a.name(), a.value());
            }
            for (const pugi::xml_node inner : node.children()) {
                if (inner.type() != pugi::node_element) continue;
                if (!parent && std::string_view(inner.name()) == "xi:include") {
                    include(inner.attribute("href").value(), place(inner.name()));
                    continue;
                }
                const MtlxElement* child = self(self, inner, &element, depth + 1);
                element.children.push_back(child);
                if (parent) add_name(element.by_name, *child);
            }
            return &element;
        };
        const MtlxElement* top = convert(convert, root, nullptr, 0);
        for (const MtlxElement* child : top->children) {
            document_.top_.push_back(child);
            add_name(document_.by_name_, *child);
        }
        open_.pop_back();
    }

private:
    void include(const std::string& name, const SourceLoc& loc) {
        const AssetPath found = reader_.find(name, loc);
        if (found.path.empty())
            throw Error(ExitCode::scene, loc, "include: file '" + name + "' " + found.reason);
        read(found.path, loc);
    }

    void add_name(std::map<std::string_view, const MtlxElement*>& names, const MtlxElement& one) {
        const std::string* name = one.find("name");
        if (!name || name->empty()) return;
        const auto [held, is_new] = names.emplace(*name, &one);
        if (is_new) return;
        reader_.problems.damage(one.loc, one.subject() + ": the name stands for " +
                                             held->second->subject() + " already (" +
                                             to_string(held->second->loc) + ")");
    }

    MtlxDocument& document_;
    SceneReader& reader_;
    std::vector<std::string> open_;
    std::set<std::string> seen_;
};

const std::string* MtlxElement::find(std::string_view attribute) const {
    for (const auto& [name, value] : attributes)
        if (name == attribute) return &value;
    return nullptr;
}

const std::string* MtlxElement::inherited(std::string_view attribute) const {
    for (const MtlxElement* at = this; at; at = at->parent)
        if (const std::string* value = at->find(attribute)) return value;
    return nullptr;
}

std::string MtlxElement::name() const {
    const std::string* name = find("name");
    return name ? *name : "";
}

std::string MtlxElement::subject() const {
    const std::string own = name();
    return own.empty() ? category : category + " '" + own + "'";
}

const MtlxElement* MtlxElement::child(std::string_view name) const {
    const auto found = by_name.find(name);
    return found == by_name.end() ? nullptr : found->second;
}

MtlxDocument::MtlxDocument(const std::string& path, const SourceLoc& from, SceneReader& reader) {
    MtlxParser(*this, reader).read(path, from);
}

const MtlxElement* MtlxDocument::find(std::string_view name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : found->second;
}

}  // namespace tessera
