#include "ingest/dataset/mirror.hpp"

#include <algorithm>
#include <cctype>
#include <map>

#include "base/error.hpp"
#include "base/text/lower_case.hpp"

namespace actformer::ingest {
namespace {

bool upper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

bool letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// The words of a joint's name in small letters: "LHipJoint", "l_hip joint" and "LeftHipJoint" have three.
std::vector<std::string> words_of(const std::string& name) {
    std::vector<std::string> words;
    bool inside = false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
            inside = false;
            continue;
        }
        const bool hump =
            upper(c) && inside &&
            (!upper(name[i - 1]) || (i + 1 < name.size() && letter(name[i + 1]) && !upper(name[i + 1])));
        if (!inside || hump) words.emplace_back();
        words.back() += lower_case(c);
        inside = true;
    }
    return words;
}

/// The words with left and right exchanged.
std::vector<std::string> exchanged(std::vector<std::string> words) {
    static const std::map<std::string, std::string> others{
        {"left", "right"}, {"right", "left"}, {"l", "r"}, {"r", "l"}};
    for (auto& word : words)
        if (const auto other = others.find(word); other != others.end()) word = other->second;
    return words;
}

}  // namespace

std::vector<std::uint32_t> other_side(const Topology& topology, const std::string& where) {
    std::vector<std::vector<std::string>> words;
    for (const auto& name : topology.names) words.push_back(words_of(name));
    std::vector<std::uint32_t> other;
    for (std::size_t k = 0; k < words.size(); ++k) {
        const auto found = std::ranges::find(words, exchanged(words[k]));
        if (found == words.end())
            throw Error("{}: joint '{}' has no counterpart on the other side; leave out mirror", where,
                        topology.names[k]);
        other.push_back(static_cast<std::uint32_t>(found - words.begin()));
    }
    bool sides = false;
    for (std::uint32_t k = 0; k < other.size(); ++k) {
        sides |= other[k] != k;
        const int parent = topology.parents[k];
        const int expected = parent < 0 ? -1 : static_cast<int>(other[static_cast<std::size_t>(parent)]);
        if (topology.parents[other[k]] != expected)
            throw Error(
                "{}: joints '{}' and '{}' do not hang on joints that mirror each other; leave out mirror",
                where, topology.names[k], topology.names[other[k]]);
    }
    if (!sides) throw Error("{}: no joint's name tells left from right; leave out mirror", where);
    return other;
}

}  // namespace actformer::ingest
