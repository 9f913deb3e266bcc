// SMPL's body model (Loper et al. 2015) out of the file that its users have from smpl.is.tue.mpg.de. No part of it is in this program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ingest/dataset/body_model.hpp"
#include "ingest/smpl/smpl24.hpp"
#include "kernels/skinning.hpp"

namespace actformer::ingest {

struct SmplBody {
    std::string name;                  ///< the file's, as in "SMPL_NEUTRAL.pkl"
    kernels::SkinnedBody skin;         ///< on smpl24()'s joints
    std::vector<std::uint32_t> faces;  ///< (faces, 3) vertices, counter-clockwise from outside

    /// The rest pose of the body of these shape parameters, the mean body's without. Throws Error for more than the model has.
    RestSkeleton rest(std::span<const float> betas = {}) const;
};

/// A .npz, or a .pkl as it is downloaded (chumpy's and scipy's classes included), of any number of vertices and shapes. Throws Error,
/// naming the file, what is wrong with it and the remedy, for a model of other joints than SMPL's 24, as SMPL+H and SMPL-X have.
SmplBody read_smpl_body(const std::filesystem::path& file);

/// The same of a file's bytes; `name` is the file's. Errors do not name it.
SmplBody parse_smpl_body(std::string_view bytes, const std::string& name);

/// Throws Error, beginning with `where`, unless `motions` are rotations of SMPL's joints: they alone turn a body.
void check_takes_body(const BodyModel& motions, const std::string& where);

}  // namespace actformer::ingest
