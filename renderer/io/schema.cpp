#include "renderer/io/schema.h"

#include <algorithm>
#include <map>
#include <vector>

#include "renderer/io/scene_toml.h"

namespace tessera {
namespace {

using Kind = Form::Kind;
using params::json;

/// A JSON object as it is put together: "key": value, ...
class Object {
public:
    Object& add(const std::string& key, const std::string& value) {
        text_ += (text_.empty() ? "" : ",") + json(key) + ":" + value;
        return *this;
    }
    std::string text() const { return "{" + text_ + "}"; }

private:
    std::string text_;
};

std::string array(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) text += (text.empty() ? "" : ",") + item;
    return "[" + text + "]";
}

std::string definition_name(const KeyList& keys) {
    std::string name = keys.title;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

std::string number_schema(const Form& form) {
    Object schema;
    schema.add("type", json(std::string(form.whole ? "integer" : "number")));
    const Limits& limits = form.limits;
    if (limits.low > -Limits::kLargest)
        schema.add(limits.open_low ? "exclusiveMinimum" : "minimum", json(limits.low));
    if (limits.high < Limits::kLargest) {
        schema.add(limits.open_high ? "exclusiveMaximum" : "maximum", json(limits.high));
    }
    return schema.text();
}

std::string list_schema(const std::string& item, int count) {
    const std::string length = std::to_string(count);
    Object schema;
    schema.add("type", "\"array\"")
        .add("items", item)
        .add("minItems", length)
        .add("maxItems", length);
    return schema.text();
}

/// Writes the schema of every list of keys it meets into one map of definitions.
class SchemaWriter {
public:
    std::string object(const KeyList& keys) {
        Object properties;
        std::vector<std::string> required;
        for (const Key& key : keys.keys) {
            properties.add(key.name, property(key));
            if (key.required) required.push_back(json(key.name));
        }
        Object schema;
        schema.add("type", "\"object\"").add("properties", properties.text());
        if (!required.empty()) schema.add("required", array(required));
        schema.add("additionalProperties", "false");
        return schema.text();
    }

    std::string definitions() const {
        Object all;
        for (const auto& [name, schema] : definitions_) all.add(name, schema);
        return all.text();
    }

private:
    std::string property(const Key& key) {
        Object schema;
        schema.add("description", json(key.help));
        if (!key.initial.empty()) schema.add("default", key.initial);
        const std::string form = form_schema(key.form);
        // A $ref hides what stands beside it in draft 7.
        const bool reference = form.find("\"$ref\"") == 1;
        if (reference) return schema.add("allOf", array({form})).text();
        const std::string text = schema.text();
        return text.substr(0, text.size() - 1) + "," + form.substr(1);
    }

    std::string reference(const KeyList& keys) {
        const std::string name = definition_name(keys);
        if (definitions_.emplace(name, "{}").second) definitions_[name] = object(keys);
        return Object().add("$ref", json("#/definitions/" + name)).text();
    }

    std::string one_of(const std::vector<const KeyList*>& tables) {
        std::vector<std::string> references;
        for (const KeyList* keys : tables) references.push_back(reference(*keys));
        return references.size() == 1 ? references[0]
                                      : Object().add("oneOf", array(references)).text();
    }

    std::string texts_schema(const Form& form) {
        std::vector<std::string> words;
        for (const std::string& word : form.choices) words.push_back(json(word));
        const std::string item =
            words.empty() ? R"({"type":"string"})" : Object().add("enum", array(words)).text();
        if (form.kind != Kind::texts) return item;
        return Object().add("type", "\"array\"").add("items", item).text();
    }

    std::string numbers_schema(const Form& form) {
        const std::string number = number_schema(form);
        std::string list = list_schema(number, form.count);
        if (form.rows > 1) list = list_schema(list, form.rows);
        return form.or_one ? Object().add("anyOf", array({number, list})).text() : list;
    }

    std::string form_schema(const Form& form) {
        switch (form.kind) {
            case Kind::boolean:
                return R"({"type":"boolean"})";
            case Kind::number:
                return number_schema(form);
            case Kind::numbers:
                return numbers_schema(form);
            case Kind::text:
            case Kind::texts:
            case Kind::choice:
                return texts_schema(form);
            case Kind::table:
                return reference(*form.tables[0]);
            case Kind::tables:
                return Object().add("type", "\"array\"").add("items", one_of(form.tables)).text();
            case Kind::named_tables:
                return Object()
                    .add("type", "\"object\"")
                    .add("additionalProperties", one_of(form.tables))
                    .text();
            case Kind::free_tables:
                return R"({"type":["object","array"]})";
            case Kind::input:
            case Kind::image: {
                std::vector<std::string> ways;
                if (form.kind == Kind::input) ways.push_back(number_schema(form));
                if (form.count > 1) ways.push_back(list_schema(ways[0], form.count));
                if (!form.tables.empty()) ways.push_back(reference(*form.tables[0]));
                for (const char* key : {"type", "node", "layers"})
                    ways.push_back(std::string(R"({"type":"object","required":[")") + key + "\"]}");
                return Object().add("anyOf", array(ways)).text();
            }
        }
        return "{}";
    }

    std::map<std::string, std::string> definitions_;
};

/// Breaks compact JSON into lines, two spaces a level; arrays of plain values stay on one.
std::string indented(const std::string& text) {
    std::string out;
    std::vector<bool> broken;
    const auto new_line = [&] { out += "\n" + std::string(2 * broken.size(), ' '); };
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"' && (i == 0 || text[i - 1] != '\\')) quoted = !quoted;
        if (quoted || c == '"') {
            out += c;
        } else if (c == '{' || c == '[') {
            out += c;
            broken.push_back(c == '{' || text[i + 1] == '{');
            if (broken.back()) new_line();
        } else if (c == '}' || c == ']') {
            const bool own_line = broken.back();
            broken.pop_back();
            if (own_line) new_line();
            out += c;
        } else if (c == ',') {
            out += c;
            if (broken.back()) {
                new_line();
            } else if (text[i + 1] != ' ') {
                out += ' ';
            }
        } else {
            out += c == ':' ? std::string(": ") : std::string(1, c);
        }
    }
    return out + "\n";
}

}  // namespace

std::string scene_schema_json() {
    SchemaWriter writer;
    const std::string root = writer.object(scene_keys());
    Object schema;
    schema.add("$schema", "\"http://json-schema.org/draft-07/schema#\"")
        .add("title", "\"Tessera scene\"");
    schema.add("definitions", writer.definitions());
    const std::string head = schema.text();
    return indented(head.substr(0, head.size() - 1) + "," + root.substr(1));
}

}  // namespace tessera
