#include "renderer/io/scene_parse.h"

// toml++ 3.3 asserts on some malformed text ("[= 1]"), and with NDEBUG it assumes instead, which is
// undefined. Its checks stay on in every build, and throw.
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>((condition) || ::tessera::parser_gave_up())

namespace tessera {
namespace {
struct ParserGaveUp {};
[[noreturn]] bool parser_gave_up() { throw ParserGaveUp{}; }
}  // namespace
}  // namespace tessera

#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#define TOML_ENABLE_UNRELEASED_FEATURES 0
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <vector>

namespace tessera {
namespace {

constexpr int kMaxNesting = 32;
constexpr std::int64_t kMaxValues = 4'000'000;

/// Walks the text once and refuses what would exhaust the stack or the memory further on: the
/// parser bounds nested arrays, but not dotted keys.
class Gate {
public:
    Gate(std::string_view text, const SourceLoc& loc) : text_(text), loc_(loc) {
        loc_.line = loc_.column = 1;
    }

    void run() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                skip_string(c);
            } else if (c == '#') {
                while (at_ < text_.size() && text_[at_] != '\n') ++at_;
            } else {
                count(c);
                ++at_;
            }
        }
    }

private:
    void count(char c) {
        if (c == '[' || c == '{') ++depth_;
        if ((c == ']' || c == '}') && depth_ > 0) --depth_;
        if (c == '.') ++dots_;
        if (c == '\n') ++loc_.line;
        const bool separates = c == ',' || c == '=' || c == '[' || c == '{' || c == '\n';
        if (separates) dots_ = 0;
        if (c == ',' || c == '\n' || c == '[' || c == '{') ++values_;
        if (depth_ > kMaxNesting || dots_ > kMaxNesting) {
            throw Error(ExitCode::scene, loc_, "nested deeper than 32 levels");
        }
        if (values_ > kMaxValues) {
            throw Error(
                ExitCode::scene, loc_,
                "more than 4 million values; put long lists of instances into a 'transforms' file");
        }
    }

    void skip_string(char quote) {
        const std::string triple(3, quote);
        const bool multi_line = text_.substr(at_, 3) == triple;
        at_ += multi_line ? 3 : 1;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '\n') {
                if (!multi_line) return;  // unterminated: the parser says so
                ++loc_.line;
            }
            if (c == '\\' && quote == '"') {
                if (at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++loc_.line;
                at_ += 2;
                continue;
            }
            if (multi_line && text_.substr(at_, 3) == triple) {
                at_ += 3;
                while (at_ < text_.size() && text_[at_] == quote)
                    ++at_;  // """" ends with a quote inside
                return;
            }
            ++at_;
            if (!multi_line && c == quote) return;
        }
    }

    std::string_view text_;
    SourceLoc loc_;
    std::size_t at_ = 0;
    int depth_ = 0;
    int dots_ = 0;
    std::int64_t values_ = 0;
};

using FileName = std::shared_ptr<const std::string>;

SourceLoc place(const toml::source_region& region, const FileName& file) {
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node& node, const FileName& file) {
    Value value;
    value.loc = place(node.source(), file);
    switch (node.type()) {
        case toml::node_type::boolean:
            value.data = node.as_boolean()->get();
            break;
        case toml::node_type::integer:
            value.data = node.as_integer()->get();
            break;
        case toml::node_type::floating_point:
            value.data = node.as_floating_point()->get();
            break;
        case toml::node_type::string:
            value.data = node.as_string()->get();
            break;
        case toml::node_type::array: {
            List list;
            list.reserve(node.as_array()->size());
            for (const toml::node& item : *node.as_array()) list.push_back(convert(item, file));
            value.data = std::move(list);
            break;
        }
        case toml::node_type::table: {
            Table table;
            for (const auto& [key, item] : *node.as_table()) {
                Value entry = convert(item, file);
                if (!item.is_table()) entry.loc = place(key.source(), file);
                table.emplace(std::string(key.str()), std::move(entry));
            }
            value.data = std::move(table);
            break;
        }
        default:
            value.data = DateOrTime{};
            break;
    }
    return value;
}

bool gives_up(std::string_view text) {
    try {
        static_cast<void>(toml::parse(text));
    } catch (const toml::parse_error&) {
        return false;
    } catch (const ParserGaveUp&) {
        return true;
    }
    return false;
}

/// The first line with which the parser gives up. It reads forward only, so that more lines never
/// help.
int line_of_giving_up(std::string_view text) {
    std::vector<std::size_t> ends;
    for (std::size_t at = text.find('\n'); at != std::string_view::npos;
         at = text.find('\n', at + 1)) {
        ends.push_back(at + 1);
    }
    const auto first = std::partition_point(
        ends.begin(), ends.end(), [&](std::size_t end) { return !gives_up(text.substr(0, end)); });
    return static_cast<int>(first - ends.begin()) + 1;
}

std::string without_prefix(std::string_view text) {
    constexpr std::string_view kPrefix = "Error while parsing ";
    std::string message(text.starts_with(kPrefix) ? text.substr(kPrefix.size()) : text);
    if (!message.empty())
        message[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(message[0])));
    return message;
}

void drop_places(Value& value) {
    value.loc.line = value.loc.column = 0;
    if (auto* list = std::get_if<List>(&value.data)) {
        for (Value& item : *list) drop_places(item);
    } else if (auto* table = std::get_if<Table>(&value.data)) {
        for (auto& [key, item] : *table) drop_places(item);
    }
}

}  // namespace

Value parse_toml(std::string_view text, const std::string& file) {
    const FileName name = std::make_shared<const std::string>(file);
    Gate(text, {name, 1, 1}).run();
    try {
        Value root = convert(toml::parse(text), name);
        root.loc = {name, 1, 1};
        return root;
    } catch (const toml::parse_error& error) {
        throw Error(ExitCode::scene, place(error.source(), name),
                    without_prefix(error.description()));
    } catch (const ParserGaveUp&) {
        throw Error(ExitCode::scene, {name, line_of_giving_up(text), 0},
                    "this line is no valid TOML");
    }
}

Value parse_toml_value(std::string_view text, const std::string& origin) {
    const SourceLoc loc{std::make_shared<const std::string>(origin), 0, 0};
    const Error bad(ExitCode::usage, loc, "the part after '=' is no TOML value");
    if (text.find_first_of("\r\n") != std::string_view::npos) throw bad;
    try {
        Value root = parse_toml("value = " + std::string(text), origin);
        Table& table = std::get<Table>(root.data);
        drop_places(root);
        return std::move(table.at("value"));
    } catch (const Error&) {
        throw bad;
    }
}

}  // namespace tessera
