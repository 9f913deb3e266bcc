// Where the tests find what they use. Asked for here alone, so that no test's object depends on where the checkout lies.
#pragma once

#include <string>

namespace actformer::test {

/// The program built beside the tests.
std::string program();

/// The process that has loaded the training's library (warm_training_server.cpp).
std::string warm_training();

/// The library that lets a program's calls fail (failing_calls.cpp).
std::string failing_calls();

/// A file of this project, as in "README.md".
std::string source(const std::string& file);

/// A file of the folder beside it with data and reference programs, which need not be there.
std::string shared(const std::string& file);

}  // namespace actformer::test
