#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "diff/diff_report.h"
#include "error.h"
#include "html_text.h"
#include "picture/color_map.h"
#include "scratch_folder.h"
#include "text/printable_text.h"
#include "text/short_text.h"

namespace isoparm {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #fff; --ink: #1b1d21; --soft: #5a6068; --line: #d4d8dd; --bad: #a03020; --good: #207040; }
@media (prefers-color-scheme: dark) { :root { --paper: #15171a; --ink: #e6e8eb; --soft: #a3abb5; --line: #3a4048; --bad: #f09080; --good: #80d0a0; } }
body { margin: 1.5rem auto; padding: 0 1.25rem; max-width: 90rem; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .3rem; overflow-wrap: anywhere; }
.soft { color: var(--soft); } .fail, .error, .not_comparable { color: var(--bad); } .pass { color: var(--good); }
.modes { display: flex; flex-wrap: wrap; gap: .4rem; margin: .6rem 0; align-items: center; }
button { font: inherit; padding: .15rem .7rem; border: 1px solid var(--line); border-radius: 4px; background: none; color: inherit; cursor: pointer; }
button[aria-pressed=true] { background: var(--ink); color: var(--paper); }
.stage { position: relative; display: flex; gap: .6rem; }
.stage figure { margin: 0; min-width: 0; flex: 1 1 0; } .stage img { display: block; width: 100%; image-rendering: pixelated; background: #fff; }
figcaption { color: var(--soft); font-size: .85rem; }
.stage figure[hidden] { display: none; }
.stage[data-mode=wipe] figure + figure { position: absolute; inset: 0; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .86rem; font-variant-numeric: tabular-nums; margin: .6rem 0; }
th, td { padding: .2rem .6rem; border-bottom: 1px solid var(--line); text-align: left; } td.n, th.n { text-align: right; }
svg { max-width: 44rem; width: 100%; height: auto; } svg text { fill: var(--soft); font-size: 11px; }
)";

// The state of a page is in its address: #pair=2&mode=wipe&at=30.
constexpr const char* kScript = R"(
'use strict';
for (const section of document.querySelectorAll('section[data-pair]')) {
  const stage = section.querySelector('.stage');
  if (!stage) continue;
  const figures = Object.fromEntries([...stage.querySelectorAll('figure')].map(f => [f.dataset.image, f]));
  const slider = section.querySelector('input');
  let timer = 0;
  const show = (...names) => { for (const [name, f] of Object.entries(figures)) f.hidden = !names.includes(name); };
  const wipe = () => { figures.b.style.clipPath = `inset(0 0 0 ${slider.value}%)`; };
  const set = mode => {
    clearInterval(timer);
    stage.dataset.mode = mode;
    figures.b.style.clipPath = '';
    slider.hidden = mode !== 'wipe';
    for (const b of section.querySelectorAll('button')) b.setAttribute('aria-pressed', String(b.value === mode));
    if (mode === 'side') show('a', 'b');
    else if (mode === 'wipe') { show('a', 'b'); wipe(); }
    else if (mode === 'flicker') {
      let shown = 'a';
      const turn = () => { show(shown); stage.dataset.shown = shown; shown = shown === 'a' ? 'b' : 'a'; };
      turn();
      timer = setInterval(turn, 500);
    } else show(mode);
  };
  for (const b of section.querySelectorAll('button')) b.addEventListener('click', () => set(b.value));
  slider.addEventListener('input', wipe);
  const asked = new URLSearchParams(location.hash.slice(1));
  const mine = asked.get('pair') === null || asked.get('pair') === section.dataset.pair;
  if (mine && asked.get('at')) slider.value = asked.get('at');
  const wanted = mine ? asked.get('mode') : null;
  set([...section.querySelectorAll('button')].some(b => b.value === wanted) ? wanted : 'side');
}
)";


/// The file that write_image makes, as a data: address.
std::string png_address(const Image& image) {
    const ScratchFolder folder;
    const std::string file = folder / "a.png";
    write_image(file, image, {});
    std::ifstream in(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return "data:image/png;base64," + base64(bytes.str());
}

/// Viridis over a logarithmic scale of three decades below `top`; equal pixels are black, what is not finite is red.
Image heat(const Image& size, const std::vector<float>& values, double top, bool logarithmic) {
    Image image{size.width, size.height, {}};
    image.pixels.reserve(4 * values.size());
    for (const float v : values) {
        Color c{0, 0, 0};
        if (!std::isfinite(v)) c = {1, 0, 0};
        else if (v > 0) c = viridis(logarithmic ? 1 + std::log10(static_cast<double>(v) / top) / 3 : static_cast<double>(v) / top);
        for (int k = 0; k < 3; ++k) image.pixels.push_back(static_cast<float>(c[k]));
        image.pixels.push_back(1);
    }
    return image;
}

std::string figure(const char* name, const std::string& caption, const Image& image, bool hidden) {
    return std::string("<figure data-image=\"") + name + "\"" + (hidden ? " hidden" : "") + "><img alt=\"" + escaped(caption) + "\" src=\"" + png_address(image) + "\"><figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

/// Samples by powers of two of their difference, on logarithmic axes; the limit is where the colour changes.
std::string histogram(const std::vector<PartDiff>& parts) {
    std::vector<std::pair<int, std::uint64_t>> bars;  // power of two, samples
    double limit = 0;
    std::uint64_t equal = 0, most = 1;
    for (const PartDiff& p : parts)
        for (const ChannelDiff& c : p.channels) {
            limit = std::max(limit, c.fail);
            for (const auto& [bin, count] : c.histogram) {
                if (bin == 0) {
                    equal += count;
                    continue;
                }
                const int power = std::max(static_cast<int>(bin >> 7) - 127, -40);
                const auto at = std::lower_bound(bars.begin(), bars.end(), std::pair<int, std::uint64_t>{power, 0});
                const auto bar = at != bars.end() && at->first == power ? at : bars.insert(at, {power, 0});
                bar->second += count;
                most = std::max(most, bar->second);
            }
        }
    if (bars.empty()) return "";
    const int first = bars.front().first, last = bars.back().first;
    const double step = 640.0 / (last - first + 1);
    std::string text = "<svg class=\"histogram\" viewBox=\"0 0 700 170\" role=\"img\" aria-label=\"Histogram of the differences\">\n";
    for (const auto& [power, count] : bars) {
        const double height = 6 + 104 * std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(most));
        char bar[256];
        std::snprintf(bar, sizeof bar, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"><title>2^%d and more: %llu samples</title></rect>\n", 30 + (power - first) * step, 130 - height, std::max(step - 2, 1.0), height,
                      std::ldexp(1, power + 1) > limit ? "#c05030" : "#4080a0", power, static_cast<unsigned long long>(count));
        text += bar;
    }
    text += "<text x=\"30\" y=\"148\">" + short_text(std::ldexp(1, first)) + "</text><text x=\"670\" y=\"148\" text-anchor=\"end\">" + short_text(std::ldexp(1, last + 1)) + "</text><text x=\"30\" y=\"164\">difference, by powers of two; " + std::to_string(equal) + " samples are equal; red: above " + short_text(limit) + "</text></svg>\n";
    return text;
}

std::string table(const ImageDiff& d) {
    std::string text = "<div class=\"scroll\"><table><thead><tr><th>channel</th><th class=\"n\">max</th><th class=\"n\">mean</th><th class=\"n\">RMS</th><th class=\"n\">PSNR</th><th class=\"n\">99 %</th><th class=\"n\">pixels above limit</th><th class=\"n\">NaN, Inf</th><th>worst</th></tr></thead><tbody>\n";
    for (const PartDiff& p : d.parts)
        for (const ChannelDiff& c : p.channels) {
            text += "<tr><td>" + escaped(printable(p.name.empty() || d.parts.size() < 2 ? c.name : p.name + "/" + c.name)) + "</td>";
            for (const double x : {c.max, c.mean(), c.rms(), c.psnr(), c.percentile(0.99)}) text += "<td class=\"n\">" + short_text(x) + "</td>";
            text += "<td class=\"n\">" + std::to_string(c.failing) + "</td><td class=\"n\">" + std::to_string(c.nonfinite) + "</td><td>" +
                    (c.differing > 0 ? short_text(c.worst.a) + " became " + short_text(c.worst.b) + " at (" + std::to_string(c.worst.x) + "," + std::to_string(c.worst.y) + ")" : "") + "</td></tr>\n";
        }
    text += "</tbody></table></div>\n";
    bool first = true;
    for (const PartDiff& p : d.parts)
        for (const PatchFailures& f : p.patches) {
            if (first) text += "<div class=\"scroll\"><table><thead><tr><th>channel</th><th class=\"n\">patch</th><th class=\"n\">pixels</th><th class=\"n\">worst</th><th>at</th><th>uv</th></tr></thead><tbody>\n";
            first = false;
            text += "<tr><td>" + escaped(printable(p.channels[f.channel].name)) + "</td><td class=\"n\">" + std::to_string(f.patch) + "</td><td class=\"n\">" + std::to_string(f.pixels) + "</td><td class=\"n\">" + short_text(f.difference) + "</td><td>(" +
                    std::to_string(f.worst.x) + "," + std::to_string(f.worst.y) + ")</td><td>(" + short_text(f.u) + ", " + short_text(f.v) + ")</td></tr>\n";
        }
    return first ? text : text + "</tbody></table></div>\n";
}

std::string stage(const DiffPreview& p, const ImageDiff& d) {
    std::string text = "<div class=\"modes\">";
    for (const auto& [mode, label] : {std::pair{"side", "Side by side"}, {"flicker", "Flicker"}, {"wipe", "Wipe"}, {"heat", "Differences"}, {"flip", "FLIP"}})
        if (mode != std::string("flip") || !p.flip.empty()) text += std::string("<button type=\"button\" value=\"") + mode + "\">" + label + "</button>";
    text += "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"Where the wipe is\" hidden></div>\n<div class=\"stage\">\n";
    const std::string scale = p.factor > 1 ? ", " + std::to_string(p.factor) + " x " + std::to_string(p.factor) + " pixels in one" : "";
    text += figure("a", "reference" + scale, p.a, false) + figure("b", "new" + scale, p.b, false);
    text += figure("heat", "largest difference of a pixel, from " + short_text(d.max / 1000) + " (dark) to " + short_text(d.max) + " (light), logarithmic; black: equal; red: NaN or Inf", heat(p.a, p.difference, d.max, true), true);
    if (!p.flip.empty()) text += figure("flip", "FLIP, from 0 (dark) to 1 (light); mean " + short_text(d.flip.value_or(0)), heat(p.a, p.flip, 1, false), true);
    return text + "</div>\n";
}

}  // namespace

void make_figures(ImageDiff& d) {
    if (d.preview) d.figures = stage(*d.preview, d);
    d.preview.reset();
}

std::string diff_page(const std::vector<ImageDiff>& all, const DiffLimits& limits) {
    std::size_t good = 0;
    for (const ImageDiff& d : all) good += d.verdict == DiffVerdict::pass;
    std::string text =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
        "<meta name=\"generator\" content=\"isoparm diff\">\n<title>Image comparison</title>\n<style>" + std::string(kStyle) + "</style>\n</head>\n<body>\n<h1>Image comparison</h1>\n<p class=\"soft\">" +
        std::to_string(good) + " of " + std::to_string(all.size()) + " pass.</p>\n";
    for (std::size_t k = 0; k < all.size(); ++k) {
        const ImageDiff& d = all[k];
        text += "<section data-pair=\"" + std::to_string(k + 1) + "\">\n<h2>" + escaped(printable(d.b)) + " <span class=\"soft\">against " + escaped(printable(d.a)) + "</span></h2>\n<p class=\"" + verdict_name(d.verdict) + "\">" + escaped(verdict_line(d, limits)) + "</p>\n";
        text += d.figures;
        if (d.compared()) {
            text += "<p>max " + short_text(d.max) + ", mean " + short_text(d.mean) + ", RMS " + short_text(d.rms) + ", PSNR " + short_text(d.psnr) + (d.flip ? ", FLIP " + short_text(*d.flip) : "") + (d.ssim ? ", SSIM " + short_text(*d.ssim) : "") + "</p>\n" + histogram(d.parts) + table(d);
        }
        text += "</section>\n";
    }
    return text + "<script>" + kScript + "</script>\n</body>\n</html>\n";
}

}  // namespace isoparm
