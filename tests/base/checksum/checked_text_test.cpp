// Texts with their checksum in a comment: no changed byte of what they say passes for what was written.
#include "base/checksum/checked_text.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;

TEST(CheckedText, TellsOfEveryByteThatIsNotAsItWasWritten) {
    const TempDir dir;
    const auto file = dir / "config.yaml";
    const auto fault_of = [&](const std::string& text) {
        write_file(file, text);
        return error_of([&] { expect_checksum_comment(file); });
    };
    const std::string text = "model: gru\nepochs: 5  # of as many windows as there are clips\n",
                      whole = with_checksum_comment(text);
    EXPECT_TRUE(whole.starts_with(text + "# checksum ")) << whole;
    EXPECT_EQ(fault_of(whole), "");
    EXPECT_EQ(fault_of(text), "") << "of an earlier version, or of somebody else";
    EXPECT_EQ(fault_of(""), "");
    EXPECT_EQ(fault_of(with_checksum_comment("")), "");
    const auto why = fault_of(replaced(whole, "epochs: 5", "epochs: 6"));
    EXPECT_NE(why.find("config.yaml: damaged; take out its last line"), std::string::npos) << why;
    const auto sum = whole.substr(0, whole.size() - 1);
    for (const auto* end : {"", "\r\n", "\n\n"}) {  // as editors leave it
        EXPECT_EQ(fault_of(sum + end), "");
        EXPECT_NE(fault_of(replaced(sum, "epochs: 5", "epochs: 6") + end), "");
    }
    const auto begins = text.size();  // of the last line
    for (std::size_t at = 0; at < whole.size(); ++at) {
        auto changed = whole;
        changed[at] ^= 1;
        const bool no_sum = at + 1 >= begins && at < begins + std::string("# checksum ").size();
        EXPECT_NE(fault_of(changed).empty(), !no_sum) << "byte " << at << ": all that it says is as it was";
    }
}
