#pragma once
// Typed, located reading of tables. A table's keys are described once, by rows of a KeySet: the
// reader, the check for unknown keys, the JSON Schema and --set all work from the same rows.

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "renderer/api/scene_desc.h"
#include "renderer/io/scene_value.h"

namespace tessera {

/// Which numbers a key takes. clamp: values outside are moved to the edge with a warning.
struct Limits {
    double low = -kLargest;
    double high = kLargest;
    bool open_low = false;  // low itself is refused
    bool open_high = false;
    bool clamp = false;

    static constexpr double kLargest =
        1e12;  // scene units, watts: beyond it float arithmetic breaks down
};
inline constexpr Limits kAnyNumber{};
inline constexpr Limits kAbove0{.low = 0, .open_low = true};
inline constexpr Limits kAtLeast0{.low = 0};
inline constexpr Limits kUnit{.low = 0, .high = 1};
inline constexpr Limits kUnitClamped{.low = 0, .high = 1, .clamp = true};

struct KeyList;

/// What a key holds.
struct Form {
    enum class Kind : std::uint8_t {
        boolean,
        number,
        numbers,  // rows x count; rows = 1 is written flat
        text,
        texts,
        choice,
        table,         // the keys of tables[0]
        tables,        // [[key]]: each has the keys of one of tables
        named_tables,  // [key.NAME]: each has the keys of tables[0]
        input,         // a number (count 1) or colour (count 3), an image: tables[0], or a node
        image,         // an image: tables[0], if there is one, or a node
        free_tables,   // [key.NAME] or [[key]] of a form of their own
    };
    Kind kind = Kind::number;
    int rows = 1;
    int count = 1;
    bool or_one = false;  // one number stands for count equal ones
    bool whole = false;
    Limits limits = {};
    std::vector<std::string> choices = {};
    std::vector<const KeyList*> tables = {};
};

struct ReadContext {
    Problems& problems;
    std::string subject;       // "camera", "material 'oak'"
    std::string noun = "key";  // what a key is called in messages
};

/// One row: a key, what it holds, what it is for, and where the value goes.
struct Key {
    using Store = std::function<void(void* object, const Value&, const Key&, const ReadContext&)>;
    std::string name;
    Form form;
    std::string help;
    Store store;
    std::string initial = {};  // the default as JSON, "" when there is none
    bool required = false;
    bool supported = true;  // false: never suggested for a mistyped key

    Key must() const {
        Key key = *this;
        key.required = true;
        key.initial.clear();
        return key;
    }
};

struct KeyList {
    std::string title;
    std::vector<Key> keys;
};

/// The keys of a table that is read into a T.
template <class T>
struct KeySet {
    KeyList list;
};

/// A value that fits its form, in its plain parts.
struct Plain {
    std::vector<double> numbers;
    std::int64_t whole = 0;
    int choice = 0;
    bool flag = false;
    std::string text;
    std::vector<std::string> texts;
};

/// The plain parts of value; nullopt after reporting why it does not fit key.form. Not for tables.
std::optional<Plain> plain_value(const Value& value, const Key& key, const ReadContext& at);
/// "key is 190, must be ..." at value's place.
void report_misfit(const Value& value, const std::string& key, const std::string& wanted,
                   const ReadContext& at);
/// What a form takes, in words: "a number", "3 numbers", "'a' or 'b'".
std::string describe(const Form& form);

void read_keys(const Value& value, const KeyList& keys, void* object, const ReadContext& at);

/// Reads the table value into object; unknown and missing keys and misfits are reported, and leave
/// their part of object as it was.
template <class T>
void read_keys(const Value& value, const KeySet<T>& keys, T& object, const ReadContext& at) {
    read_keys(value, keys.list, &object, at);
}

namespace params {

void assign(const Plain& plain, bool& out);
void assign(const Plain& plain, int& out);
void assign(const Plain& plain, std::uint64_t& out);
void assign(const Plain& plain, float& out);
void assign(const Plain& plain, double& out);
void assign(const Plain& plain, std::string& out);
void assign(const Plain& plain, std::vector<std::string>& out);
void assign(const Plain& plain, PixelWindow& out);
void assign(const Plain& plain, std::array<Double3, 2>& out);
template <class N, std::size_t count>
requires std::is_arithmetic_v<N>
void assign(const Plain& plain, std::array<N, count>& out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<N>(plain.numbers[i]);
}
template <class E>
requires std::is_enum_v<E>
void assign(const Plain& plain, E& out) { out = static_cast<E>(plain.choice); }
template <class M>
void assign(const Plain& plain, std::optional<M>& out) {
    assign(plain, out.emplace());
}

std::string json(bool flag);
std::string json(double number);
std::string json(const std::string& text);
std::string json(const std::vector<double>& numbers);

/// The form a member's type implies: a Float3 is a colour, so one number stands for grey.
Form form_of(const bool&);
Form form_of(const int&);
Form form_of(const std::uint64_t&);
Form form_of(const float&);
Form form_of(const double&);
Form form_of(const std::string&);
Form form_of(const std::vector<std::string>&);
Form form_of(const std::array<int, 2>&);
Form form_of(const Float2&);
Form form_of(const Float3&);
Form form_of(const Double3&);
Form form_of(const Matrix34&);
Form form_of(const PixelWindow&);
Form form_of(const std::array<Double3, 2>&);
template <class M>
Form form_of(const std::optional<M>&) {
    return form_of(M{});
}

template <class M>
std::string initial_of(const M& value, const Form& form) {
    if constexpr (std::is_same_v<M, std::string>) {
        return value.empty() ? "" : json(value);
    } else if constexpr (std::is_enum_v<M>) {
        return json(form.choices[static_cast<std::size_t>(value)]);
    } else if constexpr (std::is_arithmetic_v<M> && !std::is_same_v<M, bool>) {
        return json(static_cast<double>(value));
    } else if constexpr (requires { value[0] + 0.0; }) {
        return json(std::vector<double>(value.begin(), value.end()));
    } else if constexpr (requires { json(value); }) {
        return json(value);
    } else {
        return {};
    }
}

template <class T, class M>
Key key_with(std::string name, M T::*member, std::string help, Form form) {
    const auto store = [member](void* object, const Value& value, const Key& key,
                                const ReadContext& at) {
        const std::optional<Plain> plain = plain_value(value, key, at);
        if (plain) assign(*plain, static_cast<T*>(object)->*member);
    };
    std::string initial = initial_of(T{}.*member, form);
    return {std::move(name), std::move(form), std::move(help), store, std::move(initial)};
}

}  // namespace params

/// A row whose form follows from the member's type.
template <class T, class M>
Key key(std::string name, M T::*member, std::string help, const Limits& limits = kAnyNumber) {
    Form form = params::form_of(M{});
    form.limits = limits;
    return params::key_with(std::move(name), member, std::move(help), std::move(form));
}

/// A row for an enum: the words stand in the order of its values.
template <class T, class E>
Key choice(std::string name, E T::*member, std::vector<std::string> words, std::string help) {
    return params::key_with(std::move(name), member, std::move(help),
                            Form{.kind = Form::Kind::choice, .choices = std::move(words)});
}

/// A row for a text that is one of some words.
template <class T>
Key word(std::string name, std::string T::*member, std::vector<std::string> words,
         std::string help) {
    return params::key_with(std::move(name), member, std::move(help),
                            Form{.kind = Form::Kind::choice, .choices = std::move(words)});
}

/// A row for count numbers of which one may stand for all (a scale).
template <class T, class M>
Key uniform_key(std::string name, M T::*member, std::string help,
                const Limits& limits = kAnyNumber) {
    Form form = params::form_of(M{});
    form.or_one = true;
    form.limits = limits;
    return params::key_with(std::move(name), member, std::move(help), std::move(form));
}

/// Appends rows of a part to the rows of the whole that holds it.
template <class Whole, class Part>
void add_part(KeySet<Whole>& whole, const KeySet<Part>& part, Part Whole::*member) {
    for (Key key : part.list.keys) {
        key.store = [inner = key.store, member](void* object, const Value& value, const Key& row,
                                                const ReadContext& at) {
            inner(&(static_cast<Whole*>(object)->*member), value, row, at);
        };
        whole.list.keys.push_back(std::move(key));
    }
}

}  // namespace tessera
