#include "ingest/formats/babel/categories.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"
#include "base/text/trimmed_lines.hpp"

namespace actformer::ingest {
namespace {

constexpr std::array<std::string_view, 120> names{"walk",
                                                  "stand",
                                                  "hand movements",
                                                  "turn",
                                                  "interact with/use object",
                                                  "arm movements",
                                                  "t pose",
                                                  "step",
                                                  "backwards movement",
                                                  "raising body part",
                                                  "look",
                                                  "touch object",
                                                  "leg movements",
                                                  "forward movement",
                                                  "circular movement",
                                                  "stretch",
                                                  "jump",
                                                  "touching body part",
                                                  "sit",
                                                  "place something",
                                                  "take/pick something up",
                                                  "run",
                                                  "bend",
                                                  "throw",
                                                  "foot movements",
                                                  "a pose",
                                                  "stand up",
                                                  "lowering body part",
                                                  "sideways movement",
                                                  "move up/down incline",
                                                  "action with ball",
                                                  "kick",
                                                  "gesture",
                                                  "head movements",
                                                  "jog",
                                                  "grasp object",
                                                  "waist movements",
                                                  "lift something",
                                                  "knee movement",
                                                  "wave",
                                                  "move something",
                                                  "swing body part",
                                                  "catch",
                                                  "dance",
                                                  "lean",
                                                  "greet",
                                                  "poses",
                                                  "touching face",
                                                  "sports move",
                                                  "exercise/training",
                                                  "clean something",
                                                  "punch",
                                                  "squat",
                                                  "scratch",
                                                  "hop",
                                                  "play sport",
                                                  "stumble",
                                                  "crossing limbs",
                                                  "perform",
                                                  "martial art",
                                                  "balance",
                                                  "kneel",
                                                  "shake",
                                                  "grab body part",
                                                  "clap",
                                                  "crouch",
                                                  "spin",
                                                  "upper body movements",
                                                  "knock",
                                                  "adjust",
                                                  "crawl",
                                                  "twist",
                                                  "move back to original position",
                                                  "bow",
                                                  "hit",
                                                  "touch ground",
                                                  "shoulder movements",
                                                  "telephone call",
                                                  "grab person",
                                                  "play instrument",
                                                  "tap",
                                                  "spread",
                                                  "skip",
                                                  "rolling movement",
                                                  "jump rope",
                                                  "play catch",
                                                  "drink",
                                                  "evade",
                                                  "support",
                                                  "point",
                                                  "side to side movement",
                                                  "stop",
                                                  "protect",
                                                  "wrist movements",
                                                  "stances",
                                                  "wait",
                                                  "shuffle",
                                                  "lunge",
                                                  "communicate (vocalise)",
                                                  "jumping jacks",
                                                  "rub",
                                                  "dribble",
                                                  "swim",
                                                  "sneak",
                                                  "to lower a body part",
                                                  "misc. abstract action",
                                                  "mix",
                                                  "limp",
                                                  "sway",
                                                  "slide",
                                                  "cartwheel",
                                                  "press something",
                                                  "shrug",
                                                  "open something",
                                                  "leap",
                                                  "trip",
                                                  "golf",
                                                  "move misc. body part",
                                                  "get injured",
                                                  "sudden movement"};

constexpr std::uint64_t largest_file = std::uint64_t{1} << 20;

/// Names with commas between, or of a file with one a line.
std::vector<std::string> names_in(std::string text, bool file) {
    if (!file) std::replace(text.begin(), text.end(), ',', '\n');
    std::vector<std::string> out;
    for (const auto line : trimmed_lines(text)) out.push_back(printable(line));
    return out;
}

}  // namespace

std::span<const std::string_view> babel_categories() {
    return names;
}

std::vector<std::string> categories_called(const std::string& said) {
    if (!said.empty() && said.find_first_not_of("0123456789") == std::string::npos) {
        std::size_t count = 0;
        std::from_chars(said.data(), said.data() + said.size(), count);  // 0 where it is too large
        if (count < 1 || count > names.size())
            throw Error("--categories {}: give 1 to {}, BABEL's most frequent ones, or names", said,
                        names.size());
        return {names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count)};
    }
    std::error_code error;
    const bool file = std::filesystem::is_regular_file(said, error);
    std::vector<char> scratch;
    const auto out = names_in(file ? std::string(read_text(said, scratch, largest_file)) : said, file);
    const auto where = file ? said : "--categories";
    if (out.empty())
        throw Error(
            "{}: no category named; give 120, 60 or another number, names with commas between, or a file of "
            "names",
            where);
    for (auto one = out.begin(); one != out.end(); ++one)
        if (std::find(out.begin(), one, *one) != one) throw Error("{}: '{}' comes twice", where, *one);
    return out;
}

}  // namespace actformer::ingest
