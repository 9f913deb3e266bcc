// Flipped bytes in what the program wrote: whoever reads them must notice, or they must not matter.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::test {

/// What came of the flips.
struct FlipCount {
    std::size_t told = 0, made_anew = 0, without_effect = 0, silent = 0;
};

/// How many flips a test makes: `few`, or ACTFORMER_FLIPS where that is set.
inline std::size_t flips_to_make(std::size_t few) {
    const char* asked = std::getenv("ACTFORMER_FLIPS");
    return asked ? std::strtoul(asked, nullptr, 10) : few;
}

/// What a reader made of a damaged file.
struct FlipOutcome {
    std::string error;   ///< a line; empty where it went on
    bool anew = false;   ///< it said that it made the damaged file again
    std::string output;  ///< what it made
};

/// Flips a byte of `file` at random, runs `read` and compares with what it makes of the whole file; so `times` times. An error has to
/// hold one of `named`. A file of nothing but other bytes may not be without effect, unless `may_be_unread`: `read` reads it at all. The
/// file is whole again at the end.
inline void flip_and_read(const std::string& what, const std::filesystem::path& file, std::size_t times,
                          const std::vector<std::string>& named, const std::function<FlipOutcome()>& read,
                          bool may_be_unread = false) {
    const auto whole = read_file(file);
    const auto wanted = read();
    ASSERT_EQ(wanted.error, "") << what;
    ASSERT_FALSE(wanted.output.empty()) << what;
    std::mt19937_64 random(std::hash<std::string>{}(what));
    FlipCount count;
    for (std::size_t i = 0; i < times; ++i) {
        auto bytes = whole;
        const auto at = random() % bytes.size();
        bytes[at] = static_cast<char>(bytes[at] ^ (1 + random() % 255));
        write_file(file, bytes);
        const auto got = read();
        const bool names = std::ranges::any_of(
            named, [&](const std::string& name) { return got.error.find(name) != std::string::npos; });
        if (!got.error.empty()) {
            ++count.told;
            EXPECT_TRUE(names) << what << ", byte " << at << ": " << got.error;
            EXPECT_EQ(lines_in(got.error), 1) << what << ", byte " << at << ": " << got.error;
        } else if (got.output == wanted.output) {
            ++(got.anew ? count.made_anew : count.without_effect);
        } else {
            ++count.silent;
            ADD_FAILURE() << what << ": byte " << at << " of " << bytes.size() << " is now "
                          << int{static_cast<unsigned char>(bytes[at])} << ", and nobody noticed";
        }
    }
    if (!may_be_unread) {
        auto bytes = whole;
        for (auto& byte : bytes) byte = static_cast<char>(byte ^ 0xFF);
        write_file(file, bytes);
        const auto got = read();
        EXPECT_TRUE(!got.error.empty() || got.anew || got.output != wanted.output)
            << what << ": every byte is another, and nobody noticed";
    }
    write_file(file, whole);
    fmt::print("{:<22} {} flips: {} told, {} made anew, {} without effect, {} silent\n", what, times,
               count.told, count.made_anew, count.without_effect, count.silent);
}

/// The first line of `text` with `word` in it, with its end; empty where there is none.
inline std::string line_with(const std::string& text, const std::string& word) {
    const auto at = text.find(word);
    if (at == std::string::npos) return {};
    const auto begin = text.rfind('\n', at) + 1;
    return text.substr(begin, text.find('\n', at) + 1 - begin);
}

/// What came of a command that made `output`, a file or, where it is empty, what the command said. "made anew" or "made again" in that counts
/// as such. A line with `notice` in it tells that something was left out.
inline FlipOutcome outcome_of(const CommandResult& result, const std::filesystem::path& output = {},
                              const std::string& notice = {}) {
    EXPECT_LT(result.exit, 2) << result.output;
    if (result.exit != 0) {
        const auto at = result.output.rfind("actformer: ");  // behind what it said while it still went on
        return {at == std::string::npos ? "no reason given" : result.output.substr(at), false, {}};
    }
    if (const auto line = notice.empty() ? "" : line_with(result.output, notice); !line.empty())
        return {line, false, {}};
    const bool anew = result.output.find("made a") != std::string::npos;
    return {{}, anew, output.empty() ? result.output : read_file(output)};
}

/// Runs the program with `arguments`, which make the file `output`.
inline FlipOutcome outcome_of(const std::string& environment, const std::string& arguments,
                              const std::filesystem::path& output, const std::string& notice = {}) {
    std::filesystem::remove_all(output);
    return outcome_of(run_command(environment + " " + program() + " " + arguments), output, notice);
}

}  // namespace actformer::test
