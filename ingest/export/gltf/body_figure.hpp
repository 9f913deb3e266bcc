// SMPL's body as a glTF skin has it.
#pragma once

#include "ingest/export/gltf/skin_figure.hpp"
#include "ingest/smpl/body_file.hpp"

namespace actformer::ingest {

/// The mean body. Each vertex follows its four largest weights; the format has no place for pose blend shapes.
SkinFigure body_figure(const SmplBody& body);

}  // namespace actformer::ingest
