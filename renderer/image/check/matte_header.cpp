#include "renderer/image/check/matte_header.h"

#include <charconv>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "renderer/core/murmur3.h"

namespace tessera {
namespace {

constexpr std::string_view kPrefix = "cryptomatte/";

using Entries = std::map<std::string, std::string>;  // "name" -> value

std::map<std::string, Entries> collect(const RawExr& file) {
    std::map<std::string, Entries> found;
    for (const RawPart& part : file.parts) {
        for (const auto& [name, value] : part.attributes) {
            if (!name.starts_with(kPrefix) || value.first != "string") continue;
            const std::size_t slash = name.find('/', kPrefix.size());
            if (slash == std::string::npos) continue;
            found[name.substr(kPrefix.size(), slash - kPrefix.size())][name.substr(slash + 1)] =
                value.second;
        }
    }
    return found;
}

bool parse_id(const std::string& text, std::uint32_t& id) {
    const char* const end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, id, 16);
    return text.size() == 8 && code == std::errc() && stop == end;
}

void read_manifest(const std::string& text, const std::string& where, MatteHeader& header,
                   ExrFindings& out) {
    const auto bad = [&](const std::string& why) {
        out.push_back({ExrRule::matte_manifest, where, why});
    };
    // A document nested without end would recurse without end when it is destroyed.
    const auto flat = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        return depth < 8;
    };
    const nlohmann::json manifest = nlohmann::json::parse(text, flat, false);
    if (!manifest.is_object()) return bad("it is no JSON object");
    std::size_t wrong = 0;
    std::string first;
    for (const auto& [name, value] : manifest.items()) {
        std::uint32_t id = 0;
        if (!value.is_string() || !parse_id(value.get_ref<const std::string&>(), id))
            return bad("the id of '" + name + "' is not 8 hex digits");
        header.ids.insert(id);
        if (id == cryptomatte_id(name)) continue;
        if (wrong++ == 0)
            first =
                fmt::format("'{}' has {:08x}, its hash is {:08x}", name, id, cryptomatte_id(name));
    }
    header.named = true;
    if (wrong > 0)
        out.push_back({ExrRule::matte_names, where,
                       fmt::format("{} of {} names; {}", wrong, manifest.size(), first)});
}

MatteHeader read_one(const std::string& key, const Entries& entries, ExrFindings& out) {
    const auto get = [&](const char* name) {
        const auto found = entries.find(name);
        return found == entries.end() ? std::string() : found->second;
    };
    MatteHeader header{key, get("name"), false, {}};
    const std::string where = "cryptomatte '" + (header.name.empty() ? key : header.name) + "'";
    const auto metadata = [&](const std::string& what) {
        out.push_back({ExrRule::matte_metadata, where, what});
    };
    if (header.name.empty()) metadata("it has no name");
    if (get("hash") != "MurmurHash3_32") metadata("its hash is '" + get("hash") + "'");
    if (get("conversion") != "uint32_to_float32")
        metadata("its conversion is '" + get("conversion") + "'");
    const std::string expected = fmt::format("{:08x}", murmur3(header.name)).substr(0, 7);
    if (!header.name.empty() && key != expected)
        out.push_back(
            {ExrRule::matte_key, where, "it is '" + key + "', expected '" + expected + "'"});
    if (entries.contains("manifest"))
        read_manifest(get("manifest"), where, header, out);
    else if (get("manif_file").empty())
        metadata("it has no manifest");
    return header;
}

}  // namespace

std::vector<MatteHeader> read_matte_headers(const RawExr& file, ExrFindings& out) {
    std::vector<MatteHeader> headers;
    for (const auto& [key, entries] : collect(file)) headers.push_back(read_one(key, entries, out));
    return headers;
}

}  // namespace tessera
