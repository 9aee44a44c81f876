// scene_mutator.h -- libFuzzer's mutations of scenes by whole values: bytes changed at random seldom leave JSON that is read to its end.
// To be included by one source of a target; three in four mutations are these, the others libFuzzer's own.
#pragma once
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "scene/registry.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace isoparm::fuzz {

using Tokens = std::vector<std::string>;

/// Strings, numbers, words and brackets; what stands between them is left out.
inline Tokens tokens_of(std::string_view text) {
    Tokens tokens;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        std::size_t end = i + 1;
        if (std::strchr(" \t\r\n", c)) {
            ++i;
            continue;
        }
        if (c == '/') {
            i = std::min(text.find('\n', i), text.size());
            continue;
        }
        if (c == '"') {
            while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
            ++end;
        } else if (!std::strchr("{}[],:", c)) {
            end = text.find_first_of("{}[],:\" \t\r\n", i);
        }
        end = std::min(end, text.size());
        tokens.emplace_back(text.substr(i, end - i));
        i = end;
    }
    return tokens;
}

/// Keys and names of types, as the program knows them, and what expressions are made of.
inline const std::vector<std::string>& words() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> w{"parameters", "curves",  "surfaces", "objects", "panels", "layout",  "camera",     "image",   "lighting", "tessellation", "tolerance", "value", "min",   "max",   "eye",
                                   "target",     "up",      "fov",      "surface", "curve",  "net",     "point",      "axes",    "label",    "isolines",     "outline",   "comb",  "jumps", "color", "line",
                                   "dash",       "sin(t)",  "cos(u)",   "u*v",     "t^2",    "1/(t-1)", "sqrt(-u)",   "u^v^3",   "pi",       "a+b",          "exp(99*t)", "0/0",   "S",     "c0",    "hermite",
                                   "gregory",    "2x3",     "1.5pt",    "atan2(u,v)", "bounded", "unbounded", "$x_{1}^2$", "\\\\alpha", "transparent", "pixels"};
        for (const auto& t : curve_types()) w.push_back(t.name), w.insert(w.end(), t.keys.begin(), t.keys.end());
        for (const auto& t : surface_types()) w.push_back(t.name), w.insert(w.end(), t.keys.begin(), t.keys.end());
        for (const auto& [name, keys] : triangle_methods()) w.push_back(name), w.insert(w.end(), keys.begin(), keys.end());
        for (auto& word : w) word = '"' + word + '"';
        return w;
    }();
    return all;
}

class SceneMutation {
public:
    SceneMutation(Tokens tokens, unsigned seed) : t_(std::move(tokens)), random_(seed) {}
    std::string result() {
        for (std::size_t n = below(3) + 1; n > 0; --n) change();
        std::string text;
        for (const auto& token : t_) {
            const bool apart = !text.empty() && !std::strchr("{}[],:", text.back()) && !std::strchr("{}[],:", token.front());
            text += (apart ? " " : "") + token;
        }
        return text;
    }

private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
    bool is(std::size_t i, char c) const { return i < t_.size() && t_[i].front() == c; }
    /// One past the value that begins at i.
    std::size_t end_of(std::size_t i) const {
        int depth = 0;
        for (; i < t_.size(); ++i) {
            depth += is(i, '{') || is(i, '[') ? 1 : is(i, '}') || is(i, ']') ? -1 : 0;
            if (depth <= 0) return i + 1;
        }
        return t_.size();
    }
    /// Where some value begins: not a key, nor a bracket that closes. The end where none was found.
    std::size_t value() {
        for (int tries = 0; tries < 20; ++tries)
            if (const std::size_t i = below(t_.size()); i > 0 && std::strchr("{[,:", t_[i - 1].front()) && !is(i, '}') && !is(i, ']') && !is(i + 1, ':')) return i;
        return t_.size();
    }
    std::size_t word() {
        for (int tries = 0; tries < 20; ++tries)
            if (const std::size_t i = below(t_.size()); is(i, '"')) return i;
        return t_.size();
    }
    auto at(std::size_t i) { return t_.begin() + static_cast<std::ptrdiff_t>(i); }
    Tokens copy(std::size_t i) { return {at(i), at(end_of(i))}; }
    void replace(std::size_t i, const Tokens& by) {
        t_.erase(at(i), at(end_of(i)));
        t_.insert(at(i), by.begin(), by.end());
    }
    std::string scalar() {
        static const char* const odd[] = {"0", "-0", "1", "-1", "0.5", "2", "3", "1e-320", "1e-160", "1e-12", "1e30", "1e154", "1e308", "1e999", "2147483648", "null", "true", "false", "[]", "{}", "0.3333333333333333", "-7.25"};
        return below(4) == 0 ? words()[below(words().size())] : odd[below(std::size(odd))];
    }
    void change() {
        if (t_.size() < 3 || t_.size() > 2000) return;
        const std::size_t kind = below(7), i = value(), from = value(), w = word();
        if (kind == 6 && w < t_.size()) return mutate_text(t_[w]);
        if (kind == 5 && w < t_.size()) return void(t_[w] = words()[below(words().size())]);
        if (i >= t_.size()) return;
        if (kind == 0) return replace(i, tokens_of(scalar()));
        if (kind == 1 && from < t_.size()) return replace(i, copy(from));
        const bool member = is(i - 1, ':') && i >= 3;
        const std::size_t begin = member ? i - 2 : i, end = end_of(i);
        if (kind == 2) {  // left out, with the comma before or behind it
            const bool behind = is(end, ','), before = is(begin - 1, ',');
            t_.erase(at(!behind && before ? begin - 1 : begin), at(behind ? end + 1 : end));
        } else if (kind == 3) {  // once more
            Tokens again{at(begin), at(end)};
            if (member) again.front() = words()[below(words().size())];
            again.push_back(",");
            t_.insert(at(begin), again.begin(), again.end());
        } else if (is(i, '{')) {  // one more member
            const bool empty = is(i + 1, '}');
            Tokens more{words()[below(words().size())], ":"};
            const Tokens what = from < t_.size() ? copy(from) : Tokens{scalar()};
            more.insert(more.end(), what.begin(), what.end());
            if (!empty) more.push_back(",");
            t_.insert(at(i + 1), more.begin(), more.end());
        }
    }
    /// What stands between quotes, by libFuzzer's own mutations: expressions, names, labels.
    void mutate_text(std::string& quoted) {
        std::string inside = quoted.substr(1, quoted.size() < 2 ? 0 : quoted.size() - 2);
        const std::size_t size = inside.size(), most = size + 12;
        inside.resize(most);
        inside.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(inside.data()), size, most));
        quoted = '"' + inside + '"';
    }

    Tokens t_;
    std::minstd_rand random_;
};

}  // namespace isoparm::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, most);
    const std::string text = isoparm::fuzz::SceneMutation(isoparm::fuzz::tokens_of({reinterpret_cast<const char*>(data), size}), seed / 4).result();
    if (text.empty() || text.size() > most) return LLVMFuzzerMutate(data, size, most);
    std::memcpy(data, text.data(), text.size());
    return text.size();
}
