#include "renderer/film/light_path_syntax.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "renderer/film/blame.h"

namespace tessera {
namespace {

constexpr std::size_t kLongest = 4096;  // characters
constexpr std::size_t kMostNodes = 20000;
constexpr int kMostRepeats = 64;
constexpr int kDeepest = 200;

class Parser {
public:
    Parser(const std::string& text, const PathAlphabet& alphabet, const SourceLoc& loc)
        : text_(text), alphabet_(alphabet), loc_(loc) {}

    PathAutomaton parse() {
        if (text_.size() > kLongest) fail("is longer than 4096 characters");
        const Part all = either();
        if (peek() != '\0') fail(std::string("'") + peek() + "' closes nothing");
        out_.nodes[0].next = {all.first};
        out_.end = all.last;
        return std::move(out_);
    }

private:
    struct Part {
        std::uint32_t first, last;
    };

    [[noreturn]] void fail(const std::string& what) const {
        constexpr std::size_t kShown = 200;
        const std::string shown = text_.size() <= kShown ? text_ : text_.substr(0, kShown) + " ...";
        throw Error(blame(loc_), loc_,
                    "light path expression '" + shown + "', character " + std::to_string(at_ + 1) +
                        ": " + what);
    }
    char peek() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }
    void need(char c, const char* what) {
        if (!take(c)) fail(what);
    }

    std::uint32_t node() {
        if (out_.nodes.size() >= kMostNodes) fail("the expression is too large");
        out_.nodes.emplace_back();
        return static_cast<std::uint32_t>(out_.nodes.size() - 1);
    }
    Part step(std::vector<bool> events) {
        const std::uint32_t a = node(), b = node();
        out_.nodes[a].events = std::move(events);
        out_.nodes[a].next = {b};
        return {a, b};
    }
    Part nothing() {
        const std::uint32_t a = node();
        return {a, a};
    }
    void lead(std::uint32_t from, std::uint32_t to) { out_.nodes[from].next.push_back(to); }

    Part either() {
        if (++depth_ > kDeepest) fail("nested too deep");
        Part all = sequence();
        while (take('|')) {
            const Part other = sequence();
            const std::uint32_t a = node(), b = node();
            lead(a, all.first), lead(a, other.first);
            lead(all.last, b), lead(other.last, b);
            all = {a, b};
        }
        --depth_;
        return all;
    }

    Part sequence() {
        Part all = nothing();
        for (char c = peek(); c != '\0' && c != ')' && c != '|'; c = peek()) {
            const Part next = repeated();
            lead(all.last, next.first);
            all.last = next.last;
        }
        return all;
    }

    Part repeated() {
        const std::size_t start = at_;
        const Part p = atom();
        if (take('*')) return repeat(p, true, true);
        if (take('+')) return repeat(p, false, true);
        if (take('?')) return repeat(p, true, false);
        return take('{') ? counted(start) : p;
    }
    Part repeat(Part p, bool skip, bool again) {
        const std::uint32_t a = node(), b = node();
        lead(a, p.first), lead(p.last, b);
        if (skip) lead(a, b);
        if (again) lead(p.last, p.first);
        return {a, b};
    }

    // {n}, {n,} and {n,m}: the atom is read again for every time.
    Part counted(std::size_t start) {
        const int least = number();
        const bool open = take(',');
        const int most = open && peek() != '}' ? number() : (open ? -1 : least);
        need('}', "expected '}'");
        if (most >= 0 && most < least) fail("the second number is less than the first");
        const std::size_t end = at_;
        Part all = nothing();
        const auto append = [&](Part p) { lead(all.last, p.first), all.last = p.last; };
        const auto again = [&] {
            at_ = start;
            return atom();
        };
        for (int i = 0; i < least; ++i) append(again());
        for (int i = least; i < most; ++i) append(repeat(again(), true, false));
        if (most < 0) append(repeat(again(), true, true));
        at_ = end;
        return all;
    }
    int number() {
        if (!std::isdigit(static_cast<unsigned char>(peek()))) fail("expected a number");
        int n = 0;
        while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) {
            n = n * 10 + (text_[at_++] - '0');
            if (n > kMostRepeats) fail("at most 64 repetitions");
        }
        return n;
    }

    Part atom() {
        if (take('(')) {
            const Part p = either();
            need(')', "expected ')'");
            return p;
        }
        return step(take('[') ? one_of() : event());
    }

    std::vector<bool> one_of() {
        const bool none = take('^');
        std::vector<bool> set(static_cast<std::size_t>(alphabet_.size()));
        if (peek() == ']') fail("an empty set of events");
        while (!take(']')) {
            if (peek() == '\0') fail("expected ']'");
            const std::vector<bool> one = event();
            for (std::size_t i = 0; i < set.size(); ++i) set[i] = set[i] || one[i];
        }
        if (none) set.flip();
        return set;
    }

    std::vector<bool> event() {
        const char c = peek();
        if (c == '<') return spelled_out();
        if (c == '\'') return events(".", ".", {label()});
        if (c == '.' || is_type(c)) return ++at_, events(std::string(1, c), ".", {});
        if (is_scattering(c)) return ++at_, events(".", std::string(1, c), {});
        if (c == '\0') fail("ends where an event was expected");
        if (c == '*' || c == '+' || c == '?' || c == '{')
            fail(std::string("'") + c + "' repeats nothing (or use brackets: (...)" + c + ")");
        fail(std::string("'") + c +
             "' is no event (there are C R T V L O B, D G S s, '.', <...>, [...] and 'label')");
    }

    // <type scattering 'label'...>, from the left as much as is wanted.
    std::vector<bool> spelled_out() {
        need('<', "expected '<'");
        std::string type = ".", scattering = ".";
        if (peek() != '\'' && peek() != '>') type = letters(true);
        if (peek() != '\'' && peek() != '>') scattering = letters(false);
        std::vector<std::string> labels;
        while (peek() == '\'') labels.push_back(label());
        need('>', "expected a 'label' or '>'");
        return events(type, scattering, labels);
    }
    // One letter, '.', or a set of letters.
    std::string letters(bool type) {
        const auto good = [&](char c) { return type ? is_type(c) : is_scattering(c); };
        const char* const expected =
            type ? "expected a type: C, R, T, V, L, O, B or '.'" : "expected D, G, S, s or '.'";
        if (take('.')) return ".";
        if (!take('[')) {
            if (!good(peek())) fail(expected);
            return std::string(1, text_[at_++]);
        }
        const bool none = take('^');
        std::string set;
        while (!take(']')) {
            if (!good(peek())) fail(expected);
            set += text_[at_++];
        }
        if (!none) return set;
        std::string others;
        for (const char c : std::string(type ? "CRTVLOB" : "DGSs")) {
            if (set.find(c) == std::string::npos) others += c;
        }
        return others;
    }
    std::string label() {
        need('\'', "expected a 'label'");
        const std::size_t end = text_.find('\'', at_);
        if (end == std::string::npos) fail("the label has no closing quote");
        const std::string name = text_.substr(at_, end - at_);
        if (!alphabet_.knows(name))
            fail("nothing is labelled '" + name + "' (there are " + alphabet_.labels() + ")");
        at_ = end + 1;
        return name;
    }

    std::vector<bool> events(const std::string& types, const std::string& scatterings,
                             const std::vector<std::string>& labels) const {
        std::vector<bool> set(static_cast<std::size_t>(alphabet_.size()));
        for (std::size_t e = 0; e < set.size(); ++e) {
            for (const char t : types) {
                for (const char s : scatterings) {
                    if (alphabet_.matches(static_cast<int>(e), t, s, labels)) set[e] = true;
                }
            }
        }
        return set;
    }
    static bool is_type(char c) {
        return c != '\0' && std::string_view("CRTVLOB").find(c) != std::string_view::npos;
    }
    static bool is_scattering(char c) {
        return c != '\0' && std::string_view("DGSs").find(c) != std::string_view::npos;
    }

    const std::string& text_;
    const PathAlphabet& alphabet_;
    const SourceLoc& loc_;
    std::size_t at_ = 0;
    int depth_ = 0;
    PathAutomaton out_{{PathAutomaton::Node{}}, 0};
};

}  // namespace

bool PathAlphabet::matches(int event, char type, char scattering,
                           const std::vector<std::string>& labels) const {
    const auto any = [&](auto has) {
        return labels.empty() || std::any_of(labels.begin(), labels.end(), has);
    };
    if (event == kCamera)
        return (type == 'C' || type == '.') && scattering == '.' && labels.empty();
    if (event < kFirstLight) {
        const EventName& e = kEventNames[static_cast<std::size_t>(event - kFirstLobe)];
        return (type == '.' || type == e.type) &&
               (scattering == '.' || scattering == e.scattering) &&
               any([&](const std::string& l) { return l == e.label; });
    }
    const int tags = static_cast<int>(tags_.size());
    const auto light = static_cast<LightType>((event - kFirstLight) / tags);
    const LightTag& tag = tags_[static_cast<std::size_t>((event - kFirstLight) % tags)];
    const bool of_type =
        type == '.' ||
        (type == 'L' && (light == LightType::light || light == LightType::surroundings)) ||
        (type == 'O' && light == LightType::object) ||
        (type == 'B' && (light == LightType::background || light == LightType::surroundings));
    return of_type && scattering == '.' &&
           any([&](const std::string& l) { return l == tag.group_name || l == tag.name; });
}

bool PathAlphabet::knows(const std::string& label) const {
    return std::any_of(kEventNames.begin(), kEventNames.end(),
                       [&](const EventName& e) { return e.label == label; }) ||
           std::any_of(tags_.begin(), tags_.end(),
                       [&](const LightTag& t) { return t.group_name == label || t.name == label; });
}

std::string PathAlphabet::labels() const {
    constexpr std::size_t kShown = 20;
    std::set<std::string> names;
    for (const EventName& e : kEventNames) names.emplace(e.label);
    std::set<std::string> lights;
    for (const LightTag& t : tags_) {
        lights.insert(t.group_name);
        if (!t.name.empty()) lights.insert(t.name);
    }
    std::string out;
    std::size_t shown = 0;
    for (const auto* set : {&names, &lights}) {
        for (const std::string& name : *set) {
            if (++shown <= kShown) out += (out.empty() ? "'" : ", '") + name + "'";
        }
    }
    return shown > kShown ? out + " and more" : out;
}

PathAutomaton parse_light_paths(const std::string& expression, const PathAlphabet& alphabet,
                                const SourceLoc& loc) {
    return Parser(expression, alphabet, loc).parse();
}

}  // namespace tessera
