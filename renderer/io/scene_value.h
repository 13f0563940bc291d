#pragma once
// A scene file as a tree of plain values, each with its place. What the TOML parser yields, what
// includes and
// --set change, and what params.h reads.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "renderer/api/error.h"

namespace tessera {

struct Value;
using List = std::vector<Value>;
using Table = std::map<std::string, Value, std::less<>>;

/// A date or a time: TOML has them, scenes do not.
struct DateOrTime {};

struct Value {
    std::variant<bool, std::int64_t, double, std::string, DateOrTime, List, Table> data = false;
    SourceLoc loc;  // of the key for 'key = value', of the header for [table]

    const Table* table() const { return std::get_if<Table>(&data); }
    const List* list() const { return std::get_if<List>(&data); }
    const std::string* text() const { return std::get_if<std::string>(&data); }
    /// The value of a key; nullptr when there is none or this is no table.
    const Value* find(std::string_view key) const;
};

/// "190", "'box'", "a table", "an array of 2": what a message shows of a value.
std::string describe(const Value& value);
/// Shortest text that reads back as the same number.
std::string number_text(double number);

}  // namespace tessera
