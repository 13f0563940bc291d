#include "renderer/io/scene_value.h"

#include <array>
#include <charconv>
#include <cmath>

namespace tessera {
namespace {

constexpr std::size_t kShownText = 60;

struct Describe {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(double number) const {
        const std::string text = number_text(number);
        const bool whole = text.find_first_not_of("-0123456789") == std::string::npos;
        return whole ? text + ".0" : text;
    }
    std::string operator()(const std::string& text) const {
        return text.size() > kShownText ? "a long text" : "'" + text + "'";
    }
    std::string operator()(DateOrTime) const { return "a date or time"; }
    std::string operator()(const List& list) const {
        return list.empty() ? "an empty array" : "an array of " + std::to_string(list.size());
    }
    std::string operator()(const Table&) const { return "a table"; }
};

}  // namespace

const Value* Value::find(std::string_view key) const {
    const Table* entries = table();
    if (!entries) return nullptr;
    const auto found = entries->find(key);
    return found == entries->end() ? nullptr : &found->second;
}

std::string describe(const Value& value) { return std::visit(Describe{}, value.data); }

std::string number_text(double number) {
    if (!std::isfinite(number)) return std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf";
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
    return {buffer.data(), end};
}

}  // namespace tessera
