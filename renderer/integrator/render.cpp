// Tiles over the film, pass after pass.

#include "renderer/api/render.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <mutex>

#include "renderer/core/cpu_time.h"
#include "renderer/core/parallel.h"
#include "renderer/film/film.h"
#include "renderer/film/film_file.h"
#include "renderer/film/mattes.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/checkpoints.h"
#include "renderer/integrator/error_causes.h"
#include "renderer/integrator/error_watch.h"
#include "renderer/integrator/pass_plan.h"
#include "renderer/integrator/path_passes.h"
#include "renderer/integrator/resume.h"
#include "renderer/integrator/tiles.h"

namespace tessera {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class Renderer {
public:
    Renderer(const Scene& scene, const RenderSettings& settings)
        : scene_(scene),
          settings_(settings),
          window_(window_of(scene.film())),
          film_(settings.resume.empty()
                    ? Film(window_, scene.passes(), film_extras(scene, settings))
                    : resumed_film(scene, window_, settings, resumed_s_)),
          header_(film_header(scene, window_, settings)),
          times_(std::any_of(scene.passes().begin(), scene.passes().end(),
                             [](const Pass& p) { return p.source == PassSource::seconds; })),
          filter_(scene.film().filter, scene.film().filter_width_px),
          kernel_(find_kernel(scene.settings().integrator, scene.kernel())),
          tiles_(make_tiles(window_, settings.tile)),
          workers_(settings.threads),
          checkpoints_(settings.checkpoint, settings.checkpoint_s, settings.warn),
          error_(settings.target) {}

    RenderResult run() {
        const int spp = scene_.settings().spp;
        int done = static_cast<int>(sample_range(film_).least);
        resumed_ = done;
        PassPlan plan(spp, settings_.time_s, settings_.on_pass != nullptr);
        while (const int count = plan.next(done, seconds_since(start_), error_.samples_wanted())) {
            const Clock::time_point start = Clock::now();
            render_pass(done, done + count, spp);
            if (stopped_) break;
            done += count;
            plan.took(count, seconds_since(start));
            look_at_error(done);
            if (settings_.on_pass) show_pass(done);
            if (error_.reached()) break;
        }
        save();
        RenderResult r = finish(done, stopped_);
        ErrorEstimate& error = r.stats.error;
        if (!stopped_ && causes_wanted(error))
            error.causes = find_causes(scene_, film_, settings_.first_sample, workers_);
        return r;
    }

private:
    static PixelWindow window_of(const FilmDesc& film) {
        return film.crop ? *film.crop : PixelWindow{0, 0, film.width, film.height};
    }

    void render_pass(int first, int last, int spp) {
        std::atomic<int> finished{0};
        std::vector<char> done(tiles_.size());
        do {
            render_tiles(first, last, spp, done, finished);
        } while (save_or_show(first));
    }

    // Those not done yet; leaves some when the picture so far is wanted.
    void render_tiles(int first, int last, int spp, std::vector<char>& done,
                      std::atomic<int>& finished) {
        std::atomic<bool> begun{false};  // so that whoever wants it often does not stop everything
        workers_.for_each(static_cast<int>(tiles_.size()), [&](int t) {
            if (done[t] || cancelled() || (begun && interrupted())) return;
            const bool whole = render_tile(tiles_[t], last);
            begun = true;
            if (!whole) return;
            done[t] = 1;
            if (settings_.on_tile) settings_.on_tile(tiles_[t], film_.layers(tiles_[t]));
            const double share =
                static_cast<double>(finished.fetch_add(1) + 1) / static_cast<double>(tiles_.size());
            report(first + (last - first) * share, spp, last);
        });
    }

    bool cancelled() {
        if (settings_.cancel && settings_.cancel->load(std::memory_order_relaxed)) stopped_ = true;
        return stopped_;
    }

    bool snapshot_wanted() const {
        return settings_.snapshot && settings_.snapshot->load(std::memory_order_relaxed);
    }

    bool interrupted() { return cancelled() || snapshot_wanted() || checkpoints_.wanted(); }

    // No block is under way. Whether the render goes on after an interruption.
    bool save_or_show(int done) {
        if (stopped_) return false;
        bool interrupted = false;
        if (checkpoints_.wanted()) {
            checkpoints_.start(film_, header(), workers_);
            interrupted = true;
        }
        if (snapshot_wanted()) {
            settings_.snapshot->store(false);
            if (!settings_.film_file.empty()) save_part_so_far();
            RenderResult so_far = finish(done, true);
            so_far.complete = so_far.stats.complete = false;
            settings_.on_snapshot(std::move(so_far));
            interrupted = true;
        }
        return interrupted;
    }

    // With the workers at rest, unless it is the checkpoint, which its own thread writes.
    void save_part_so_far() {
        if (settings_.film_file == settings_.checkpoint) return checkpoints_.hurry();
        try {
            write_film_file(settings_.film_file, header(), film_);
        } catch (const std::exception& e) {
            if (settings_.warn) settings_.warn(std::string("snapshot: ") + e.what());
        }
    }

    const FilmHeader& header() {
        const SampleCounts counts = sample_range(film_);
        header_.least = counts.least, header_.most = counts.most;
        header_.seconds = resumed_s_ + seconds_since(start_);
        return header_;
    }

    // A part that is its own checkpoint is written once.
    bool is_own_checkpoint() const {
        return !settings_.film_file.empty() && settings_.checkpoint == settings_.film_file;
    }

    void save() {
        const std::string& file = settings_.film_file;
        if (is_own_checkpoint())
            checkpoints_.stop();  // the one under way would replace the whole
        else
            checkpoints_.finish(film_, header());
        if (!file.empty()) write_film_file(file, header(), film_);
    }

    // False if it was interrupted; the film knows how far each block is.
    bool render_tile(const PixelWindow& tile, int last) {
        Counters counters;
        BlockJob job;
        job.scene = &scene_;
        job.filter = &filter_;
        BlockSamples samples;
        PassSamples passes = film_.pass_samples();
        PathPasses path_passes(scene_, passes);
        if (film_.takes_passes()) job.passes = &path_passes;
        bool whole = true;
        for (int y = tile.y0 & ~(kBlockSize - 1); whole && y < tile.y1; y += kBlockSize) {
            for (int x = tile.x0 & ~(kBlockSize - 1); whole && x < tile.x1; x += kBlockSize) {
                aim_block(job, x, y, scene_.settings().seed);
                job.lanes = lanes_inside(tile, x, y);
                whole = render_block(job, last, samples, passes, counters);
            }
        }
        Counters second;
        if (whole && film_.probes()) whole = render_probes(tile, last, second);
        counters.add_rays(second.rays);
        const std::lock_guard lock(mutex_);
        counters_.add(counters);
        return whole;
    }

    // A second time, with other scrambles; sixteen at once, wherever they lie.
    bool render_probes(const PixelWindow& tile, int last, Counters& counters) {
        Probes& probes = *film_.probes();
        std::vector<std::size_t> cells;
        probes.grid().each_inside(
            tile, [&](std::size_t cell, ProbeGrid::Pixel) { cells.push_back(cell); });
        const std::uint64_t seed = probe_seed(scene_.settings().seed);
        for (std::size_t first = 0; first < cells.size(); first += kLanes) {
            const std::size_t count = std::min<std::size_t>(kLanes, cells.size() - first);
            BlockJob job;
            job.scene = &scene_;
            job.filter = &filter_;
            for (std::size_t i = 0; i < count; ++i) {
                const ProbeGrid::Pixel p = probes.grid().probe(cells[first + i]);
                aim_lane(job, static_cast<int>(i), p.x, p.y, seed);
            }
            if (!render_again(job, {&cells[first], count}, last, counters)) return false;
        }
        return true;
    }

    // The cells' probes need not have equally many samples: a run that was resumed had other tiles.
    bool render_again(BlockJob& job, std::span<const std::size_t> cells, int last,
                      Counters& counters) {
        Probes& probes = *film_.probes();
        BlockSamples samples;
        for (std::uint32_t n = 0; n < static_cast<std::uint32_t>(last); ++n) {
            job.lanes = 0;
            for (std::size_t i = 0; i < cells.size(); ++i)
                if (probes.samples(cells[i]) == n) job.lanes |= 1u << i;
            if (job.lanes == 0) continue;
            choose_sample(job, static_cast<std::uint32_t>(settings_.first_sample) + n);
            kernel_(job, samples, counters);
            for (std::size_t i = 0; i < cells.size(); ++i)
                if ((job.lanes >> i) & 1u) probes.add(cells[i], samples[i].radiance);
            if (interrupted()) return false;
        }
        return true;
    }

    bool render_block(BlockJob& job, int last, BlockSamples& samples, PassSamples& passes,
                      Counters& counters) {
        const int lane = std::countr_zero(job.lanes);  // all have equally many samples
        for (int n = static_cast<int>(film_.samples(job.x[lane], job.y[lane])); n < last; ++n) {
            choose_sample(job, static_cast<std::uint32_t>(settings_.first_sample + n));
            if (job.passes && times_)
                timed(job, samples, passes, counters);
            else
                kernel_(job, samples, counters);
            for (int i = 0; i < kLanes; ++i) {
                if ((job.lanes >> i) & 1u)
                    film_.add(job.x[i], job.y[i], job.sample, samples[i],
                              job.passes ? &passes : nullptr, i);
            }
            if (interrupted()) return false;
        }
        return true;
    }

    // Every pixel of a block has an equal part of its time.
    void timed(const BlockJob& job, BlockSamples& samples, PassSamples& passes,
               Counters& counters) const {
        const auto start = Clock::now();
        kernel_(job, samples, counters);
        const double each = seconds_since(start) / std::popcount(job.lanes);
        for (float& s : passes.seconds) s = static_cast<float>(each);
    }

    void report(double samples, int spp, int pass_end) {
        if (!settings_.progress) return;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock) return;
        const double elapsed = seconds_since(start_);
        if (elapsed - last_report_ < 0.1 && samples < spp) return;
        last_report_ = elapsed;
        Progress p;
        p.fraction = samples / spp;
        if (settings_.time_s > 0)
            p.fraction = std::max(p.fraction, std::min(1.0, elapsed / settings_.time_s));
        if (settings_.target && !error_.curve().empty()) {
            p.error = error_.curve().back();
            if (const double s = p.error->forecast.wall_s.value; s > 0)
                p.fraction = std::max(p.fraction, std::min((resumed_s_ + elapsed) / s, 0.99));
        }
        p.elapsed_s = elapsed;
        p.eta_s = p.fraction > 0 ? elapsed * (1 - p.fraction) / p.fraction : 0;
        p.spp = pass_end;
        settings_.progress(p);
    }

    void look_at_error(int done) {
        const bool news = error_.look(film_, workers_, done, resumed_s_ + seconds_since(start_),
                                      process_cpu_seconds() - cpu_start_);
        if (news && settings_.on_error) settings_.on_error(error_.curve().back());
    }

    // As if no time had gone by.
    void show_pass(int done) {
        const Clock::time_point begun = Clock::now();
        const double cpu = process_cpu_seconds();
        settings_.on_pass(finish(done, false));
        cpu_start_ += process_cpu_seconds() - cpu;
        start_ += Clock::now() - begun;
    }

    // within: a pass is not through.
    RenderResult finish(int done, bool within) {
        RenderResult r;
        if (within)
            error_.look_within(film_, workers_);
        else
            look_at_error(done);
        r.complete = !stopped_;
        r.image.width = scene_.film().width;
        r.image.height = scene_.film().height;
        r.image.window = window_;
        r.image.working_space = scene_.film().working_space;
        r.image.layers = film_.layers(workers_);
        if (film_.deep()) r.deep = deep_image();
        r.stats = scene_.statistics();
        Statistics& s = r.stats;
        s.threads = workers_.threads();
        s.tile = settings_.tile;
        s.spp = done;
        s.first_sample = settings_.first_sample;
        s.resumed_spp = resumed_;
        s.resumed_s = resumed_s_;
        s.checkpoints = checkpoints_.written();
        s.checkpoints_failed = checkpoints_.failed();
        s.checkpoint_saved = checkpoints_.saved() || is_own_checkpoint();
        s.checkpoint_s = checkpoints_.rested_s();
        s.checkpoint_every_s = settings_.checkpoint.empty() ? 0 : checkpoints_.every_s();
        s.render_s = seconds_since(start_);
        s.error = error_.latest();
        s.error_curve = error_.curve();
        s.error_target = settings_.target;
        s.error_reached = error_.reached();
        s.rays = counters_.rays;
        s.samples = counters_.samples;
        s.invalid = counters_.invalid;
        s.memory_film = film_.bytes() + checkpoints_.bytes();
        count_textures(scene_, s);
        s.complete = r.complete;
        if (counters_.first.set) {
            const auto& f = counters_.first;
            s.first_invalid = std::string(to_string(f.cause)) + " at pixel " + std::to_string(f.x) +
                              "," + std::to_string(f.y) + " sample " + std::to_string(f.sample);
        }
        add_mattes(film_, header_.ids, r.image.layers, s.notes);
        r.image.metadata = header_.metadata;
        if (film_.deep()) note_crowds(*film_.deep(), s.notes);
        if (film_.passes().empty()) s.left_out.push_back({"passes", "only beauty was asked for"});
        return r;
    }

    bool causes_wanted(const ErrorEstimate& e) const {
        return e.known && (settings_.error_causes || !e.rmse.reliable || !e.relmse.reliable);
    }

    DeepImage deep_image() const {
        DeepImage image = film_.deep_image();
        image.width = scene_.film().width;
        image.height = scene_.film().height;
        image.working_space = scene_.film().working_space;
        return image;
    }

    Clock::time_point start_ = Clock::now();  // before the film, which takes a while to make
    double cpu_start_ = process_cpu_seconds();
    const Scene& scene_;
    const RenderSettings& settings_;
    PixelWindow window_;
    double resumed_s_ = 0;  // of the runs before, set with film_
    int resumed_ = 0;       // samples of those
    Film film_;
    FilmHeader header_;
    bool times_;  // a pass wants them
    FilterSampler filter_;
    BlockKernel kernel_;
    std::vector<PixelWindow> tiles_;
    Workers workers_;
    std::atomic<bool> stopped_{false};
    std::mutex mutex_;
    Counters counters_;
    double last_report_ = -1;
    Checkpoints checkpoints_;
    ErrorWatch error_;
};

}  // namespace

RenderResult render(const Scene& scene, const RenderSettings& settings) {
    if (settings.tile < kBlockSize || settings.tile % kBlockSize != 0) {
        throw Error(ExitCode::usage,
                    "tile is " + std::to_string(settings.tile) + ", must be a multiple of 4");
    }
    return Renderer(scene, settings).run();
}

}  // namespace tessera
