#include "page_style.hpp"

namespace drape::report {

std::string_view page_style() {
  return R"css(
:root {
  color-scheme: light dark;
  --paper: #f5f6f8; --card: #ffffff; --ink: #1a1f26; --soft: #566070; --line: #dde2e8;
  --accent: #0a6570; --accent-soft: #e0f0f1; --plate: #eceef1; --code: #f1f3f6;
  --ok: #17693f; --ok-soft: #e0f3e8; --review: #7a4d00; --review-soft: #fdf0d5; --review-line: #e8b34b;
  --failed: #a3211a; --failed-soft: #fce7e5; --failed-line: #e2857f; --bar: #2f9aa6; --bar-old: #b4bfca;
  --stage: #eef0f3; --shadow: 0 1px 2px rgba(20, 30, 45, .06), 0 4px 14px rgba(20, 30, 45, .05);
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #12161b; --card: #1a2027; --ink: #e7eaee; --soft: #9fabb8; --line: #2d353f;
    --accent: #5cc8d2; --accent-soft: #16343a; --plate: #232a33; --code: #141920;
    --ok: #6fd6a0; --ok-soft: #15332a; --review: #f3c367; --review-soft: #362a12; --review-line: #7a5c1d;
    --failed: #ff9d95; --failed-soft: #3b1c1c; --failed-line: #7f3733; --bar: #3aa7b3; --bar-old: #47525f;
    --stage: #20262d; --shadow: none;
  }
  img { filter: brightness(.92); }
}
* { box-sizing: border-box; }
html { scroll-behavior: smooth; scroll-padding-top: 1rem; -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif;
}
a { color: var(--accent); }
:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; border-radius: 4px; }
h1, h2, h3, p, ul, dl, dd, figure, table, pre { margin: 0; padding: 0; }
h1 { font-size: clamp(1.6rem, 1.2rem + 1.6vw, 2.3rem); line-height: 1.15; letter-spacing: -.02em; overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; line-height: 1.25; letter-spacing: -.01em; }
h3 { font-size: .8rem; line-height: 1.3; font-weight: 650; color: var(--soft); text-transform: uppercase; letter-spacing: .07em; margin: 1.7rem 0 .7rem; }
code, pre { font-family: ui-monospace, "SF Mono", Menlo, Consolas, "Liberation Mono", monospace; font-size: .875rem; }
.skip { position: absolute; left: -100vw; }
.skip:focus { left: 1rem; top: 1rem; z-index: 3; background: var(--card); padding: .5rem 1rem; }
.frame { display: grid; grid-template-columns: 13.5rem minmax(0, 1fr); gap: 2.5rem; max-width: 82rem; margin: 0 auto; padding: 2.25rem 2rem 4rem; }
main { display: grid; gap: 1.5rem; min-width: 0; align-content: start; }

nav { position: sticky; top: 2.25rem; align-self: start; max-height: calc(100vh - 4.5rem); overflow: auto; font-size: .925rem; }
.brand { font-weight: 750; letter-spacing: -.02em; font-size: 1.15rem; padding: 0 .75rem .9rem; }
.brand small { display: block; font-weight: 400; font-size: .8rem; letter-spacing: 0; color: var(--soft); }
nav ul { list-style: none; }
nav a { display: flex; gap: .6rem; align-items: center; padding: .36rem .75rem; border-radius: 7px; color: var(--ink); text-decoration: none; }
nav a:hover { background: var(--accent-soft); color: var(--accent); }
nav .group { margin: .8rem 0; padding: .8rem 0; border: solid var(--line); border-width: 1px 0; }
nav .name { flex: 1; min-width: 0; overflow-wrap: anywhere; }
.dot { flex: none; width: .55rem; height: .55rem; border-radius: 50%; background: var(--bar); }
.dot.reused { background: none; border: 2px solid var(--bar-old); }
.dot.failed { background: var(--failed); border-radius: 1px; transform: rotate(45deg); }
.flag { color: var(--review); font-weight: 700; }

.card { background: var(--card); border: 1px solid var(--line); border-radius: 14px; padding: 1.6rem 1.75rem 1.75rem; box-shadow: var(--shadow); min-width: 0; }
.eyebrow { color: var(--soft); font-size: .9rem; margin-bottom: .35rem; }
.titleline { display: flex; flex-wrap: wrap; gap: .6rem 1rem; align-items: center; }
.meta { color: var(--soft); margin-top: .6rem; font-size: .95rem; }
.pill { display: inline-flex; align-items: center; gap: .4em; padding: .16rem .7rem; border-radius: 99px; font-size: .85rem; font-weight: 650; white-space: nowrap; }
.pill.ok { background: var(--ok-soft); color: var(--ok); }
.pill.review { background: var(--review-soft); color: var(--review); }
.pill.failed { background: var(--failed-soft); color: var(--failed); }
.pill.ran { background: var(--accent-soft); color: var(--accent); }
.pill.reused { background: var(--plate); color: var(--soft); }
.note { border: 1px solid var(--review-line); border-left-width: 5px; background: var(--review-soft); border-radius: 9px; padding: .8rem 1rem; margin-top: 1.2rem; overflow-wrap: anywhere; }
.note.failed { border-color: var(--failed-line); background: var(--failed-soft); }
.note strong { display: block; color: var(--review); }
.note.failed strong { color: var(--failed); }
.note ul { padding-left: 1.15rem; }

.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(10.5rem, 1fr)); gap: 1px; background: var(--line); border: 1px solid var(--line); border-radius: 11px; overflow: hidden; margin-top: 1.4rem; }
.tiles > div { background: var(--card); padding: .85rem 1.05rem .95rem; display: flex; flex-direction: column; }
.tiles dt { color: var(--soft); font-size: .85rem; }
.tiles .value { font-size: 1.6rem; line-height: 1.3; font-weight: 600; letter-spacing: -.02em; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.tiles .unit { font-size: 1rem; font-weight: 400; color: var(--soft); letter-spacing: 0; }
.tiles .meaning { color: var(--soft); font-size: .82rem; line-height: 1.4; }

.view { margin-top: 1.4rem; }
.stage { position: relative; height: clamp(20rem, 58vh, 38rem); border: 1px solid var(--line); border-radius: 11px; overflow: hidden; background: var(--stage); }
.stage canvas { display: block; width: 100%; height: 100%; touch-action: none; cursor: grab; }
.stage canvas:active { cursor: grabbing; }
.stage canvas:focus-visible { outline-offset: -3px; }
.tools { display: flex; flex-wrap: wrap; gap: .6rem; margin-top: .8rem; }
.choice { display: inline-flex; flex-wrap: wrap; border: 1px solid var(--line); border-radius: 9px; overflow: hidden; }
button { font: inherit; font-size: .9rem; color: var(--ink); background: var(--card); border: 1px solid var(--line); border-radius: 9px; padding: .35rem .8rem; cursor: pointer; }
button:hover { background: var(--accent-soft); color: var(--accent); }
button[aria-pressed=true] { background: var(--accent); color: var(--card); }
button:disabled { opacity: .45; cursor: default; }
.choice button { border: 0; border-radius: 0; border-right: 1px solid var(--line); }
.choice button:last-child { border-right: 0; }
.lights { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 15rem), 1fr)); gap: .5rem 1.5rem; margin-top: .8rem; }
.lights[hidden] { display: none; }
.slider { display: grid; grid-template-columns: auto minmax(3rem, 1fr) 3.2rem; white-space: nowrap; gap: .7rem; align-items: center; font-size: .9rem; color: var(--soft); }
.slider input { width: 100%; accent-color: var(--accent); }
.slider output { text-align: right; font-variant-numeric: tabular-nums; color: var(--ink); }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: .3rem 1.3rem; margin-top: .8rem; font-size: .9rem; color: var(--soft); }
.legend:empty { display: none; }
.chip { display: inline-block; width: .85rem; height: .85rem; border-radius: 3px; margin-right: .5rem; vertical-align: -.1rem; }
.stage.small { height: clamp(15rem, 40vh, 24rem); }
.middle { position: absolute; left: 50%; top: 50%; width: 9px; height: 9px; margin: -5px; border: 1px solid var(--soft); border-radius: 50%; pointer-events: none; }
#mend .choice { max-width: 100%; }
.hint { margin: .8rem 0; color: var(--soft); max-width: 46rem; }
.bench { display: grid; grid-template-columns: minmax(0, 3fr) minmax(0, 2fr); gap: 1.2rem; align-items: start; }
.pad { width: 100%; display: block; border-radius: 9px; border: 1px solid var(--line); background: var(--plate); cursor: crosshair; touch-action: none; }
.panel { display: grid; gap: .8rem; justify-items: start; }
.panel > .slider, .panel > .stage, .panel > .poses { width: 100%; }
.panel .slider { grid-template-columns: minmax(4.5rem, auto) minmax(3rem, 1fr) 3.4rem; }
.poses { display: grid; grid-template-columns: repeat(auto-fill, minmax(7.5rem, 1fr)); gap: .6rem; }
.poses:empty { display: none; }
.poses button { padding: .35rem; display: grid; gap: .3rem; font-size: .82rem; }
.poses img { width: 100%; border-radius: 5px; }
.check { display: inline-flex; gap: .5rem; align-items: center; font-size: .93rem; }
.check input { accent-color: var(--accent); width: 1.1rem; height: 1.1rem; }
.outcome pre { max-height: 16rem; overflow: auto; }
.outcome .meta { margin: .9rem 0 .5rem; }
button.main { background: var(--accent); color: var(--card); font-weight: 650; }
button.main:hover:not(:disabled) { filter: brightness(1.1); color: var(--card); }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 17rem), 1fr)); gap: 1.2rem; }
.pictures.large { grid-template-columns: repeat(auto-fit, minmax(min(100%, 16rem), 1fr)); margin-top: 1.2rem; }
.slot { min-width: 0; }
.wide { grid-column: 1 / -1; }
.double { grid-column: span 2; }
.large .double { grid-column: 1 / -1; }
figure .plate { display: flex; align-items: center; justify-content: center; background: var(--plate); border: 1px solid var(--line); border-radius: 9px; overflow: hidden; cursor: zoom-in; }
.slot:not(.wide) .plate { aspect-ratio: 4 / 3; }
.slot.double .plate { aspect-ratio: auto; }
.slot.double img { height: auto; }
figure img { display: block; max-width: 100%; max-height: 100%; width: auto; height: auto; object-fit: contain; }
.slot:not(.wide) img { width: 100%; height: 100%; }
figcaption { margin-top: .5rem; font-size: .87rem; line-height: 1.45; color: var(--soft); overflow-wrap: anywhere; }
dt::first-letter, .numbers th::first-letter { text-transform: uppercase; }
figcaption b { color: var(--ink); font-weight: 650; }
.slot .plate.broken { aspect-ratio: auto; padding: 2rem 1rem; color: var(--soft); cursor: default; font-size: .9rem; text-align: center; }
.close { display: none; }
figure:target { position: fixed; inset: 0; z-index: 9; background: #0c1015; padding: 1.2rem; display: flex; flex-direction: column; align-items: center; justify-content: center; }
.slot figure:target .plate { background: none; border: 0; border-radius: 0; aspect-ratio: auto; flex: 1; min-height: 0; width: 100%; cursor: default; }
.slot figure:target img { width: 100%; height: 100%; filter: none; }
figure:target figcaption { color: #c5ccd5; max-width: 60rem; text-align: center; }
figure:target figcaption b { color: #fff; }
figure:target .close { display: block; position: absolute; top: .8rem; right: .8rem; padding: .35rem .9rem; border-radius: 8px; background: #2a323c; color: #fff; text-decoration: none; font-weight: 600; }

.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .93rem; }
th, td { text-align: left; padding: .5rem .9rem .5rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
thead th { color: var(--soft); font-weight: 600; font-size: .83rem; white-space: nowrap; }
tbody tr:last-child > * { border-bottom: 0; }
tfoot th, tfoot td { border-top: 2px solid var(--line); border-bottom: 0; font-weight: 650; }
tbody th { font-weight: 500; }
.figure { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; padding-right: 1.8rem; }
.times { margin-top: 1rem; }
.times th, .times td { vertical-align: middle; }
.times .share { width: 34%; padding-right: 0; vertical-align: middle; }
.track { display: block; height: .6rem; border-radius: 4px; background: var(--plate); overflow: hidden; }
.track span { display: block; height: 100%; background: var(--bar); border-radius: 4px; min-width: 2px; }
.track .reused { background: var(--bar-old); }
.numbers .meaning, .numbers th, .options th { overflow-wrap: anywhere; }
.numbers.bare { width: auto; min-width: 45%; }
.times th { white-space: nowrap; }
.numbers .meaning { color: var(--soft); width: 55%; padding-right: 0; }
.numbers .figure { font-weight: 600; }
.numbers .words { overflow-wrap: anywhere; max-width: 34rem; }
.numbers .unit { font-weight: 400; color: var(--soft); }

.head { display: flex; flex-wrap: wrap; gap: .3rem .9rem; align-items: center; }
.head .cost { margin-left: auto; color: var(--soft); font-size: .9rem; font-variant-numeric: tabular-nums; }
.summary { color: var(--soft); margin-top: .35rem; max-width: 46rem; }
.options code { overflow-wrap: anywhere; }
.options { width: auto; min-width: 45%; }
.options th { padding-right: 2.5rem; }
pre { background: var(--code); border: 1px solid var(--line); border-radius: 9px; padding: .85rem 1rem; overflow-x: auto; line-height: 1.5; tab-size: 2; }
pre.wrap { white-space: pre-wrap; overflow-wrap: anywhere; }
summary { cursor: pointer; color: var(--accent); font-weight: 600; }
details pre { margin-top: .7rem; }
footer { color: var(--soft); font-size: .85rem; text-align: center; padding-top: .5rem; }

@media (max-width: 62rem) {
  .frame { display: block; padding: 0 1.25rem 3rem; }
  html { scroll-padding-top: 4rem; }
  nav { top: 0; z-index: 2; margin: 0 -1.25rem 1.1rem; padding: .5rem .75rem; background: var(--paper); border-bottom: 1px solid var(--line); max-height: none; display: flex; align-items: center; overflow-x: auto; scrollbar-width: none; }
  nav::-webkit-scrollbar { display: none; }
  .brand { padding: 0 .6rem; font-size: 1rem; }
  .brand small { display: none; }
  nav ul, nav .group { display: flex; margin: 0; padding: 0; border: 0; }
  nav a { padding: .34rem .6rem; white-space: nowrap; }
}
@media (max-width: 36rem) {
  .frame { padding: 0 .8rem 2.5rem; }
  nav { margin: 0 -.8rem .8rem; }
  main { gap: .9rem; }
  .card { padding: 1.15rem 1.05rem 1.25rem; border-radius: 11px; }
  .tiles { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .tiles > div:last-child:nth-child(odd) { grid-column: 1 / -1; }
  .tiles .value { font-size: 1.35rem; }
  .times .share { display: none; }
  .numbers thead { position: absolute; left: -100vw; }
  .numbers tr { display: grid; grid-template-columns: minmax(0, 1fr) auto; padding: .5rem 0; border-bottom: 1px solid var(--line); }
  .numbers tr:last-child { border-bottom: 0; }
  .numbers th, .numbers td { border: 0; padding: 0; }
  .numbers th { padding-right: .9rem; }
  th, td { padding-right: .7rem; }
  .figure { padding-right: 1rem; }
  .times { font-size: .88rem; }
  .times th, .times td { padding-right: .3rem; }
  .times .figure { padding-right: 0; padding-left: .6rem; }
  .times .pill { padding: .1rem .5rem; font-size: .8rem; }
  .numbers.bare { width: 100%; }
  .slot.double { grid-column: auto; }
  .bench { grid-template-columns: minmax(0, 1fr); }
  .stage { height: 64vw; min-height: 17rem; }
  .numbers .figure { padding-right: 0; }
  .numbers .words { grid-column: 1 / -1; color: var(--soft); }
  .numbers .meaning { grid-column: 1 / -1; width: auto; font-size: .85rem; }
  .head .cost { margin-left: 0; flex-basis: 100%; }
}
@media print {
  body { background: #fff; }
  nav, .skip { display: none; }
  .frame { display: block; padding: 0; }
  .card { box-shadow: none; border: 0; border-top: 1px solid var(--line); border-radius: 0; padding: 1rem 0; }
  figure, tr { break-inside: avoid; }
}
@media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
)css";
}

}  // namespace drape::report
