// Naming a class on a command line or in a file of labels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace actformer::ingest {

/// The label, counted from 0, that `said` means: a class's name ("shaking hands"), whatever its case; its number from 1 on ("7");
/// or as names of generated motions have it ("A007"). A name comes first, so that a class may be called "7". Without `classes`, of
/// which then nothing is known, any number from 1 on passes. Throws Error, beginning with `where`, with the name that was
/// probably meant.
std::uint32_t label_called(const std::string& said, const std::vector<std::string>& classes,
                           const std::string& where);

}  // namespace actformer::ingest
