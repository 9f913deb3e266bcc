// A skeleton that the user names: a known one, or a file of joints and parents.
#pragma once

#include <string>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

/// One of known_topologies(), or the one in a JSON or YAML file: `names` and `parents`, -1 for the root, which is joint 0; `parents` may also be
/// names. Throws Error naming the file and what is wrong in it.
Topology topology_called(const std::string& name_or_file);

}  // namespace actformer::ingest
