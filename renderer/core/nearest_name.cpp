#include "renderer/core/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

namespace tessera {
namespace {

constexpr std::size_t kLongestWord = 64;
constexpr int kEditCost = 2;  // an edit weighs two cuts at '_'

std::string lower(std::string_view word) {
    std::string text(word);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

int tolerated_edits(std::size_t length) {
    return length < 3 ? 0 : length < 6 ? 1 : length < 12 ? 2 : 3;
}

/// Cost of taking word for name, or limit when it is not near.
int cost(const std::string& word, const std::string& name, int limit) {
    int best = limit;
    const auto try_part = [&](std::string_view part, int cuts) {
        const int edits =
            edit_distance(word, part, tolerated_edits(std::min(word.size(), part.size())) + 1);
        if (edits > tolerated_edits(std::min(word.size(), part.size()))) return;
        best = std::min(best, edits * kEditCost + cuts);
    };
    try_part(name, 0);
    int cuts = 0;
    for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
        try_part(std::string_view(name).substr(at + 1), ++cuts);
    }
    cuts = 0;
    for (std::size_t at = name.rfind('_'); at != std::string::npos && at > 0;
         at = name.rfind('_', at - 1)) {
        try_part(std::string_view(name).substr(0, at), ++cuts);
    }
    return best;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b, int limit) {
    const int difference = std::abs(static_cast<int>(a.size()) - static_cast<int>(b.size()));
    if (difference >= limit) return limit;
    std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return std::min(last[b.size()], limit);
}

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
    if (word.empty() || word.size() > kLongestWord) return {};
    constexpr int kFar = 100;
    const std::string wanted = lower(word);
    int best = kFar;
    std::string found;
    for (const std::string& name : names) {
        if (name.size() > kLongestWord) continue;
        const int c = cost(wanted, lower(name), best);
        if (c < best) {
            best = c;
            found = name;
        }
    }
    return found;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> names) {
    const std::string name = nearest_name(word, names);
    return name.empty() ? std::string() : " (did you mean '" + name + "'?)";
}

}  // namespace tessera
