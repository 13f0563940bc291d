#pragma once
// MaterialX documents as a tree of elements, each with its place. The only part that sees the XML
// parser.

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/io/scene_reader.h"

namespace tessera {

struct MtlxElement {
    std::string category;  // "nodegraph", "input", "multiply"
    SourceLoc loc;
    const MtlxElement* parent = nullptr;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<const MtlxElement*> children;
    std::map<std::string_view, const MtlxElement*> by_name;  // of children; the first of a name

    /// An attribute's text; nullptr when there is none.
    const std::string* find(std::string_view attribute) const;
    /// The same, of this element or the nearest one around it that has it.
    const std::string* inherited(std::string_view attribute) const;
    std::string name() const;
    /// "image 'bark'", as messages call it.
    std::string subject() const;
    const MtlxElement* child(std::string_view name) const;
};

/// A document and what it includes.
class MtlxDocument {
public:
    /// Throws Error(scene) for what is no MaterialX document: broken XML, entities and doctypes,
    /// nesting beyond 64, more than 200 000 elements or 256 attributes of one, includes in circles.
    /// Two of one name beside each other are reported. `from` is where the scene names the file.
    MtlxDocument(const std::string& path, const SourceLoc& from, SceneReader& reader);
    MtlxDocument(const MtlxDocument&) = delete;
    MtlxDocument& operator=(const MtlxDocument&) = delete;

    /// Elements directly in a document, the included ones first.
    const std::vector<const MtlxElement*>& top() const { return top_; }
    const MtlxElement* find(std::string_view name) const;

private:
    friend class MtlxParser;
    std::deque<MtlxElement> elements_;
    std::vector<const MtlxElement*> top_;
    std::map<std::string_view, const MtlxElement*> by_name_;
};

}  // namespace tessera
