#pragma once

#include <gtest/gtest.h>

#include <string>

namespace actformer::test {

/// `text` with the first `what` in it replaced; a test fails where there is none.
inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

}  // namespace actformer::test
