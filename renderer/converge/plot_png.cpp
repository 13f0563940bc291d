#include "renderer/converge/plot_png.h"

#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>

#include "renderer/api/error.h"

namespace tessera {
namespace {

template <auto Free>
struct Releases {
    template <class T>
    void operator()(T* p) const {
        Free(p);
    }
};
template <class T, auto Free>
using Held = std::unique_ptr<T, Releases<Free>>;

[[noreturn]] void fail(const std::string& why) {
    throw Error(ExitCode::output, "plot: cannot draw: " + why);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned count) {
    static_cast<std::string*>(bytes)->append(data, data + count);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string png_of_svg(const std::string& svg, double scale) {
    GError* error = nullptr;
    const Held<RsvgHandle, g_object_unref> handle(
        rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
    const Held<GError, g_error_free> unread(error);
    if (!handle) fail(error->message);
    double width = 0, height = 0;
    if (!rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width, &height))
        fail("it has no size");
    const RsvgRectangle page{0, 0, std::ceil(width * scale), std::ceil(height * scale)};
    const Held<cairo_surface_t, cairo_surface_destroy> surface(cairo_image_surface_create(
        CAIRO_FORMAT_RGB24, static_cast<int>(page.width), static_cast<int>(page.height)));
    const Held<cairo_t, cairo_destroy> context(cairo_create(surface.get()));
    GError* bad = nullptr;
    const bool drawn = rsvg_handle_render_document(handle.get(), context.get(), &page, &bad);
    const Held<GError, g_error_free> unread_too(bad);
    if (!drawn) fail(bad->message);
    std::string bytes;
    const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append, &bytes);
    if (status != CAIRO_STATUS_SUCCESS) fail(cairo_status_to_string(status));
    return bytes;
}

}  // namespace tessera
