#include "renderer/io/params.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "renderer/core/nearest_name.h"

namespace tessera {
namespace {

using Kind = Form::Kind;

constexpr const char* kImage = "an image ({ file = ... }), ";
constexpr const char* kNode = "a node ({ type = ... }) or layers ({ layers = [...] })";

bool is_number(const Value& value) {
    return std::holds_alternative<std::int64_t>(value.data) ||
           std::holds_alternative<double>(value.data);
}

double as_double(const Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value.data))
        return static_cast<double>(*whole);
    return std::get<double>(value.data);
}

bool inside(double number, const Limits& limits) {
    const bool low_fits = limits.open_low ? number > limits.low : number >= limits.low;
    const bool high_fits = limits.open_high ? number < limits.high : number <= limits.high;
    return low_fits && high_fits;
}

std::string limits_text(const Limits& limits) {
    const bool low = limits.low > -Limits::kLargest;
    const bool high = limits.high < Limits::kLargest;
    if (limits.low == limits.high) return number_text(limits.low);
    if (low && high) {
        return std::string("in ") + (limits.open_low ? "(" : "[") + number_text(limits.low) + ", " +
               number_text(limits.high) + (limits.open_high ? ")" : "]");
    }
    if (low) return (limits.open_low ? "above " : "at least ") + number_text(limits.low);
    if (high) return (limits.open_high ? "below " : "at most ") + number_text(limits.high);
    return "between -1e12 and 1e12";
}

std::string choices_text(const std::vector<std::string>& choices) {
    std::string text;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        if (i > 0) text += i + 1 == choices.size() ? " or " : ", ";
        text += "'" + choices[i] + "'";
    }
    return text;
}

/// Reads numbers one by one against the limits of a key.
class NumberReader {
public:
    NumberReader(const Key& key, const ReadContext& at) : key_(key), at_(at) {}

    std::optional<double> read(const Value& value, const std::string& name) {
        if (!is_number(value) ||
            (key_.form.whole && !std::holds_alternative<std::int64_t>(value.data))) {
            const std::string one = key_.form.whole ? "a whole number" : "a number";
            report_misfit(value, name, name == key_.name ? describe(key_.form) : one, at_);
            return std::nullopt;
        }
        const double number = as_double(value);
        if (!std::isfinite(number)) {
            report_misfit(value, name, "finite", at_);
            return std::nullopt;
        }
        if (inside(number, key_.form.limits)) return number;
        const Limits& limits = key_.form.limits;
        if (limits.clamp) {
            at_.problems.warn(value.loc, at_.subject + ": " + name + " is " + describe(value) +
                                             ", clamped to [" + number_text(limits.low) + ", " +
                                             number_text(limits.high) + "]");
            return std::clamp(number, limits.low, limits.high);
        }
        const Limits outer{};
        const bool huge = number < outer.low || number > outer.high;
        const bool in_view = inside(std::clamp(number, outer.low, outer.high), limits);
        report_misfit(value, name, limits_text(huge && in_view ? outer : limits), at_);
        return std::nullopt;
    }

private:
    const Key& key_;
    const ReadContext& at_;
};

bool read_row(const Value& value, const std::string& name, const Key& key, const ReadContext& at,
              std::vector<double>& numbers) {
    NumberReader reader(key, at);
    const List& list = *value.list();
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto number = reader.read(list[i], name + "[" + std::to_string(i) + "]");
        if (!number) return false;
        numbers.push_back(*number);
    }
    return true;
}

std::optional<std::vector<double>> read_numbers(const Value& value, const Key& key,
                                                const ReadContext& at) {
    const Form& form = key.form;
    const auto count = static_cast<std::size_t>(form.count);
    const auto rows = static_cast<std::size_t>(form.rows);
    std::vector<double> numbers;
    if (form.or_one && !value.list()) {
        const auto one = NumberReader(key, at).read(value, key.name);
        if (!one) return std::nullopt;
        return std::vector<double>(count * rows, *one);
    }
    const auto misfit = [&](const Value& where) {
        report_misfit(where, key.name, describe(form), at);
        return std::nullopt;
    };
    if (!value.list()) return misfit(value);
    if (form.rows == 1) {
        if (value.list()->size() != count) return misfit(value);
        if (!read_row(value, key.name, key, at, numbers)) return std::nullopt;
        return numbers;
    }
    if (value.list()->size() != rows) return misfit(value);
    for (std::size_t r = 0; r < rows; ++r) {
        const Value& row = (*value.list())[r];
        if (!row.list() || row.list()->size() != count) return misfit(row);
        if (!read_row(row, key.name + "[" + std::to_string(r) + "]", key, at, numbers))
            return std::nullopt;
    }
    return numbers;
}

std::optional<std::vector<std::string>> read_texts(const Value& value, const Key& key,
                                                   const ReadContext& at) {
    if (!value.list()) {
        report_misfit(value, key.name, describe(key.form), at);
        return std::nullopt;
    }
    std::vector<std::string> texts;
    const std::vector<std::string>& known = key.form.choices;
    for (const Value& item : *value.list()) {
        const std::string name = key.name + "[" + std::to_string(texts.size()) + "]";
        if (!item.text()) {
            report_misfit(item, name, "a text", at);
            return std::nullopt;
        }
        if (!known.empty() && std::find(known.begin(), known.end(), *item.text()) == known.end()) {
            report_misfit(item, name, choices_text(known), at);
            return std::nullopt;
        }
        texts.push_back(*item.text());
    }
    return texts;
}

void report_unknown(const std::string& name, const Value& value, const KeyList& keys,
                    const ReadContext& at) {
    std::vector<std::string> names;
    for (const Key& key : keys.keys) {
        if (key.supported) names.push_back(key.name);
    }
    const std::string subject = at.subject.empty() ? "" : at.subject + ": ";
    const std::string hint = did_you_mean(name, names);
    at.problems.error(value.loc, subject + "unknown " + at.noun + " '" + name + "'" + hint);
}

}  // namespace

std::string describe(const Form& form) {
    const std::string number = form.whole ? "whole number" : "number";
    switch (form.kind) {
        case Kind::boolean:
            return "true or false";
        case Kind::number:
            return "a " + number;
        case Kind::numbers: {
            std::string many = std::to_string(form.count) + " " + number + "s in brackets";
            if (form.rows > 1) return std::to_string(form.rows) + " rows of " + many;
            return form.or_one ? "one number or " + many : many;
        }
        case Kind::text:
            return "a text in quotes";
        case Kind::texts:
            return "texts in brackets";
        case Kind::choice:
            return choices_text(form.choices);
        case Kind::table:
        case Kind::named_tables:
        case Kind::free_tables:
            return "a table";
        case Kind::tables:
            return "tables ([[...]])";
        case Kind::input: {
            const std::string list =
                form.count > 1 ? std::to_string(form.count) + " numbers in brackets, " : "";
            return "a number, " + list + kImage + kNode;
        }
        case Kind::image:
            return std::string(form.tables.empty() ? "" : kImage) + kNode;
    }
    return {};
}

void report_misfit(const Value& value, const std::string& key, const std::string& wanted,
                   const ReadContext& at) {
    const std::string subject = at.subject.empty() ? "" : at.subject + ": ";
    at.problems.error(value.loc, subject + key + " is " + describe(value) + ", must be " + wanted);
}

std::optional<Plain> plain_value(const Value& value, const Key& key, const ReadContext& at) {
    const Form& form = key.form;
    Plain plain;
    bool fits = false;
    switch (form.kind) {
        case Kind::boolean:
            if (const bool* flag = std::get_if<bool>(&value.data)) {
                plain.flag = *flag;
                fits = true;
            }
            break;
        case Kind::number: {
            const auto number = NumberReader(key, at).read(value, key.name);
            if (!number) return std::nullopt;
            plain.numbers = {*number};
            if (form.whole) plain.whole = std::get<std::int64_t>(value.data);
            return plain;
        }
        case Kind::numbers: {
            auto numbers = read_numbers(value, key, at);
            if (!numbers) return std::nullopt;
            plain.numbers = std::move(*numbers);
            return plain;
        }
        case Kind::texts: {
            auto texts = read_texts(value, key, at);
            if (!texts) return std::nullopt;
            plain.texts = std::move(*texts);
            return plain;
        }
        case Kind::text:
        case Kind::choice: {
            if (!value.text()) break;
            plain.text = *value.text();
            const auto found = std::find(form.choices.begin(), form.choices.end(), plain.text);
            plain.choice = static_cast<int>(found - form.choices.begin());
            fits = form.kind == Kind::text || found != form.choices.end();
            break;
        }
        default:
            break;
    }
    if (fits) return plain;
    report_misfit(value, key.name, describe(form), at);
    return std::nullopt;
}

void read_keys(const Value& value, const KeyList& keys, void* object, const ReadContext& at) {
    if (!value.table()) {
        at.problems.error(value.loc, at.subject + " is " + describe(value) + ", must be a table");
        return;
    }
    for (const Key& key : keys.keys) {
        const Value* found = value.find(key.name);
        if (found) {
            key.store(object, *found, key, at);
        } else if (key.required) {
            at.problems.error(value.loc,
                              at.subject + ": " + at.noun + " '" + key.name + "' is missing");
        }
    }
    for (const auto& entry : *value.table()) {
        const std::string& name = entry.first;
        const auto same = [&](const Key& key) { return key.name == name; };
        const bool known = std::any_of(keys.keys.begin(), keys.keys.end(), same);
        if (!known) report_unknown(name, entry.second, keys, at);
    }
}

namespace params {

void assign(const Plain& plain, bool& out) { out = plain.flag; }
void assign(const Plain& plain, int& out) {
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    out = static_cast<int>(std::clamp(plain.whole, -kMost, kMost));
}
void assign(const Plain& plain, std::uint64_t& out) {
    out = static_cast<std::uint64_t>(plain.whole);
}
void assign(const Plain& plain, float& out) { out = static_cast<float>(plain.numbers[0]); }
void assign(const Plain& plain, double& out) { out = plain.numbers[0]; }
void assign(const Plain& plain, std::string& out) { out = plain.text; }
void assign(const Plain& plain, std::vector<std::string>& out) { out = plain.texts; }
void assign(const Plain& plain, PixelWindow& out) {
    const auto at = [&](std::size_t i) { return static_cast<int>(plain.numbers[i]); };
    out = {at(0), at(1), at(2), at(3)};
}
void assign(const Plain& plain, std::array<Double3, 2>& out) {
    for (std::size_t i = 0; i < 6; ++i) out[i / 3][i % 3] = plain.numbers[i];
}

std::string json(bool flag) { return flag ? "true" : "false"; }

std::string json(double number) {
    if (!std::isfinite(number)) return {};
    const float narrow = static_cast<float>(number);
    if (static_cast<double>(narrow) != number) return number_text(number);
    // Members that are float show the digits a person would write: 0.3, not 0.30000001192092896.
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), narrow).ptr;
    return {text.data(), end};
}

std::string json(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

std::string json(const std::vector<double>& numbers) {
    std::string list = "[";
    for (const double number : numbers) list += (list.size() > 1 ? ", " : "") + json(number);
    return list + "]";
}

namespace {
Form numbers(int rows, int count, bool or_one = false, bool whole = false) {
    return {.kind = Kind::numbers, .rows = rows, .count = count, .or_one = or_one, .whole = whole};
}
}  // namespace

Form form_of(const bool&) { return {.kind = Kind::boolean}; }
Form form_of(const int&) { return {.kind = Kind::number, .whole = true}; }
Form form_of(const std::uint64_t&) { return {.kind = Kind::number, .whole = true}; }
Form form_of(const float&) { return {.kind = Kind::number}; }
Form form_of(const double&) { return {.kind = Kind::number}; }
Form form_of(const std::string&) { return {.kind = Kind::text}; }
Form form_of(const std::vector<std::string>&) { return {.kind = Kind::texts}; }
Form form_of(const std::array<int, 2>&) { return numbers(1, 2, false, true); }
Form form_of(const Float2&) { return numbers(1, 2); }
Form form_of(const Float3&) { return numbers(1, 3, true); }
Form form_of(const Double3&) { return numbers(1, 3); }
Form form_of(const Matrix34&) { return numbers(3, 4); }
Form form_of(const PixelWindow&) { return numbers(1, 4, false, true); }
Form form_of(const std::array<Double3, 2>&) { return numbers(2, 3); }

}  // namespace params
}  // namespace tessera
