#pragma once
// What all writers of OpenEXR files share; for the .cpp files that own the library.

#include <ImfHeader.h>
#include <ImfIO.h>

#include <string>
#include <utility>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/image/atomic_file.h"

namespace tessera {

/// OpenEXR's stream over an AtomicFile, so that no error of the disk is lost in a library's buffer.
class ExrStream : public Imf::OStream {
public:
    explicit ExrStream(AtomicFile& file) : OStream(file.target().c_str()), file_(file) {}
    void write(const char bytes[], int count) override;
    std::uint64_t tellp() override;
    void seekp(std::uint64_t position) override;

private:
    AtomicFile& file_;
};

/// A frame of width x height with pixels in a window, in lines from the top, and its primaries.
Imf::Header exr_header(int width, int height, const PixelWindow& window,
                       const std::string& working_space);

/// Throws Error(bug) for names that are taken or that older readers refuse.
void put_metadata(const std::vector<std::pair<std::string, MetadataValue>>& metadata,
                  Imf::Header& header);

/// Gives OpenEXR's pool, which the process shares, at least as many threads as one file keeps busy;
/// returns how many to use. asked: as WriteOptions.
int exr_threads(int asked);

}  // namespace tessera
