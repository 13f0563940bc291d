#include <algorithm>
#include <cctype>
#include <charconv>
#include <memory>

#include "renderer/core/nearest_name.h"
#include "renderer/io/scene_document.h"
#include "renderer/io/scene_parse.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxSteps = 16;

/// One step of a path: a key, or the number in brackets.
struct Step {
    std::string name;
    int index = -1;
};

struct Assignment {
    std::vector<Step> path;
    std::string value;
    SourceLoc loc;  // "--set camera.fov_deg=35"
};

/// Splits light."key one"[0].radiance=3 at its dots, brackets and first '='.
class AssignmentReader {
public:
    explicit AssignmentReader(const std::string& text) : text_(text) {
        out_.loc.file = std::make_shared<const std::string>("--set " + text);
    }

    Assignment read() {
        do {
            out_.path.push_back({name()});
            while (peek() == '[') out_.path.push_back(index());
            if (out_.path.size() > kMaxSteps) fail();
        } while (take('.'));
        if (!take('=')) fail();
        out_.value = text_.substr(at_);
        return out_;
    }

private:
    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }
    [[noreturn]] void fail() const {
        throw Error(ExitCode::usage, out_.loc, "must be KEY=VALUE, like camera.fov_deg=35");
    }

    std::string name() {
        const bool quoted = take('"');
        const std::size_t end = text_.find_first_of(quoted ? "\"" : ".=[]\"", at_);
        if (end == std::string::npos || end == at_) fail();
        std::string word = text_.substr(at_, end - at_);
        at_ = end + (quoted ? 1 : 0);
        return word;
    }

    Step index() {
        constexpr int kMost = 100'000'000;
        Step step;
        const char* begin = text_.data() + at_ + 1;
        const auto [end, failed] = std::from_chars(begin, text_.data() + text_.size(), step.index);
        if (failed != std::errc() || step.index < 0 || step.index > kMost) fail();
        at_ = static_cast<std::size_t>(end - text_.data());
        if (!take(']')) fail();
        return step;
    }

    const std::string& text_;
    std::size_t at_ = 0;
    Assignment out_;
};

/// A bare word needs no quotes on a command line: film.filter=box.
bool is_bare_word(const std::string& text) {
    const auto fits = [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/';
    };
    const bool starts =
        !text.empty() && (std::isalpha(static_cast<unsigned char>(text[0])) || text[0] == '_');
    const bool is_value = text == "true" || text == "false" || text == "inf" || text == "nan";
    return starts && !is_value && std::all_of(text.begin(), text.end(), fits);
}

Value value_of(const Assignment& set) {
    if (is_bare_word(set.value)) return {set.value, set.loc};
    return parse_toml_value(set.value, *set.loc.file);
}

class Setter {
public:
    Setter(const Assignment& set, const KeyList& keys, Problems& problems)
        : set_(set), keys_(keys), problems_(problems) {}

    void apply(Value& document) {
        Value* at = &document;
        for (std::size_t i = 0; i < set_.path.size() && at; ++i) at = enter(*at, i);
        if (!at) return;
        const SourceLoc loc = set_.loc;
        *at = value_of(set_);
        at->loc = loc;
    }

private:
    Value* enter(Value& at, std::size_t i) {
        const Step& step = set_.path[i];
        if (step.index >= 0) return item(at, i);
        if (std::holds_alternative<List>(at.data)) return named(at, i);
        if (!std::holds_alternative<Table>(at.data)) {
            // 'base_color = 0.5' grows into a table when base_color.file is set.
            at = {Table{}, set_.loc};
        }
        Table& table = std::get<Table>(at.data);
        const auto found = table.find(step.name);
        if (found != table.end()) return &found->second;
        if (i == 0 && is_list_of_tables(step.name) && set_.path.size() > 1) {
            problems_.error(set_.loc, "the scene has no [[" + step.name + "]]");
            return nullptr;
        }
        Value fresh{Table{}, set_.loc};
        const bool is_material = i == 1 && set_.path[0].name == "material" && set_.path.size() > 2;
        if (is_material) fresh.data = Table{{"inherits", Value{step.name, set_.loc}}};
        return &table.emplace(step.name, std::move(fresh)).first->second;
    }

    Value* item(Value& at, std::size_t i) {
        const auto index = static_cast<std::size_t>(set_.path[i].index);
        auto* list = std::get_if<List>(&at.data);
        if (list && index < list->size()) return &(*list)[index];
        const std::string length =
            list ? std::to_string(list->size()) + " of them" : "no array there";
        problems_.error(set_.loc,
                        "there is no " + written(i) + " (" + length + ", counted from 0)");
        return nullptr;
    }

    Value* named(Value& at, std::size_t i) {
        const std::string& wanted = set_.path[i].name;
        std::vector<std::string> names;
        for (Value& entry : std::get<List>(at.data)) {
            const Value* name = entry.find("name");
            if (!name || !name->text()) continue;
            if (*name->text() == wanted) return &entry;
            names.push_back(*name->text());
        }
        problems_.error(set_.loc, "there is no " + written(i) + did_you_mean(wanted, names));
        return nullptr;
    }

    bool is_list_of_tables(const std::string& name) const {
        const auto matches = [&](const Key& key) {
            return key.name == name && key.form.kind == Form::Kind::tables;
        };
        return std::any_of(keys_.keys.begin(), keys_.keys.end(), matches);
    }

    /// The path up to and with step i.
    std::string written(std::size_t i) const {
        std::string text;
        for (std::size_t k = 0; k <= i; ++k) {
            const Step& step = set_.path[k];
            const bool is_index = step.index >= 0;
            text +=
                is_index ? "[" + std::to_string(step.index) + "]" : (k > 0 ? "." : "") + step.name;
        }
        return text;
    }

    const Assignment& set_;
    const KeyList& keys_;
    Problems& problems_;
};

}  // namespace

void apply_set(Value& document, const std::string& assignment, const KeyList& keys,
               Problems& problems) {
    const Assignment set = AssignmentReader(assignment).read();
    const std::string& first = set.path.front().name;
    if (first == "include" || first == "tessera") {
        throw Error(ExitCode::usage, set.loc, "'" + first + "' belongs into the scene file");
    }
    Setter(set, keys, problems).apply(document);
}

}  // namespace tessera
