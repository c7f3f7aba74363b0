// Loads small files for the tests of the model readers.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "models/model.h"
#include "temporary_folder.h"

/// Loads `bytes` as a file called `name`.
sundog::Model load_text(const std::string& name, std::string_view bytes,
                        const sundog::ModelOptions& options = {});

/// The message of the SceneError that loading throws, without the folder; "" if it loads.
std::string load_error(const std::string& name, std::string_view bytes);
std::string load_error(const std::filesystem::path& path);

/// `bytes` in gzip format.
std::string gzipped(std::string_view bytes);

/// The sum of the triangles' areas.
double area_of(const sundog::Mesh& mesh);
