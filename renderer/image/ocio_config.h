#pragma once
// One OpenColorIO config: a user's file, or a small one made in code. The only door to OpenColorIO.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tessera {

/// All const functions may be called from several threads.
class OcioConfig {
public:
    /// file "" = the built-in config. Throws Error(ExitCode::scene) naming the file.
    explicit OcioConfig(const std::string& file);
    ~OcioConfig();
    OcioConfig(const OcioConfig&) = delete;
    OcioConfig& operator=(const OcioConfig&) = delete;

    /// The config's name for a space, alias or role; families of names we know are tried as well.
    std::optional<std::string> find(const std::string& name) const;
    /// Whether a space found is not colour (normals, masks).
    bool is_data(const std::string& found) const;
    std::vector<std::string> spaces() const;
    /// Views of the default display.
    std::vector<std::string> views() const;

    /// rgb (3 interleaved floats a pixel) between spaces that find() gave, in place.
    void convert(std::span<float> rgb, const std::string& from, const std::string& to) const;
    /// rgb to the default display, in place. view "" = the default one, else one of views().
    void display(std::span<float> rgb, const std::string& from, const std::string& view) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
