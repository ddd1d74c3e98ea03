// Fills the page with what the benchmark says.
"use strict";
{
  const report = pageData;
  const hidden = new Set();

  const SWEEPS = {
    layers: { title: "More layers", unit: "layers" },
    triangles: { title: "More triangles, the same surfaces", unit: "triangles" },
    resolution: { title: "More pixels", unit: "pixels" },
    samples: { title: "More samples a pixel", unit: "samples a pixel" },
    cap: { title: "More layers exactly", unit: "layers that are blended exactly" },
  };
  const MARKS = ["circle", "rect", "triangle", "rectRot", "crossRot", "star"];

  // A setting's name; the samples are the step of a sweep over them.
  function settingOf(scene, measured) {
    const several = measured.samples > 1 && scene.sweep !== "samples";
    return measured.setting + (several ? `, ${measured.samples} samples` : "");
  }

  const unique = (values) => [...new Set(values)];
  const settingsOf = (scenes) => unique(scenes.flatMap((scene) => scene.measurements.map((m) => settingOf(scene, m))));
  const settings = settingsOf(report.scenes);
  const colorOf = (setting) => colorAt(settings.indexOf(setting));
  const markOf = (setting) => MARKS[settings.indexOf(setting) % MARKS.length];
  const measurementOf = (scene, setting) => scene.measurements.find((m) => settingOf(scene, m) === setting);
  const nameOf = (scene) => scene.scene + (scene.count === null ? "" : ` × ${whole(scene.count)}`);

  // The scenes of each sweep, and those of none, in order.
  const groups = unique(report.scenes.map((scene) => scene.sweep)).map((sweep) => ({
    id: sweep ?? "scenes",
    sweep,
    scenes: report.scenes.filter((scene) => scene.sweep === sweep),
    drawn: report.scenes.filter((scene) => scene.sweep === sweep && scene.measurements.length > 0),
  })).filter((group) => group.drawn.length > 0);

  // Of the processor alone, times are by the clock and there is no baseline.
  const onProcessor = report.api === "CPU";
  const MEASURES = [
    ...(onProcessor ? [] : [{ id: "ratio", title: "Cost, times unsorted", of: (m) => m.cost_ratio, text: ratio }]),
    ...(report.cpu && !onProcessor ? [] : [{ id: "cost", title: "Cost, ms", of: (m) => m.cost_ms.median, text: (v) => v.toFixed(3) }]),
    { id: "memory", title: "Memory, MiB", of: (m) => m.memory_bytes / MIB, text: (v) => v.toFixed(1) },
  ];

  function fillHeader() {
    byId("title").textContent = `Transparency methods measured on ${report.device}`;
    document.title = `${report.device} – transparency methods measured`;
    const steps = report.scenes.length;
    byId("subject").textContent = groups.every((group) => group.sweep !== null)
      ? `Sweeps over ${groups.map((group) => group.id).join(", ")}: ${settings.length} settings at ${steps} steps.`
      : `${settings.length} settings in ${steps} ${steps === 1 ? "picture" : "pictures"}.`;
    byId("machine").textContent = machineText(report);
    if (onProcessor) byId("cost-note").textContent = "Cost is the time by the clock for the whole picture.";
  }

  function fillAdvice() {
    for (const { sweep } of groups) {
      const parts = report.recommendation.filter((advice) => advice.sweep === sweep);
      if (parts.length === 0) continue;
      if (groups.length > 1) add(byId("advice"), "h3", sweep === null ? "Scenes" : SWEEPS[sweep].title);
      const list = add(byId("advice"), "dl");
      for (const advice of parts) {
        add(list, "dt", advice.need);
        add(list, "dd", advice.text);
      }
    }
  }

  function fillMethods() {
    for (const setting of settings) {
      const button = add(byId("methods"), "button", undefined, { type: "button", "aria-pressed": "true" });
      add(button, "i").style.background = colorOf(setting);
      button.append(setting);
      button.addEventListener("click", () => {
        if (!hidden.delete(setting)) hidden.add(setting);
        button.setAttribute("aria-pressed", String(!hidden.has(setting)));
        for (const chart of charts) {
          chart.data.datasets.forEach((data, i) => chart.setDatasetVisibility(i, !hidden.has(data.label)));
          chart.update();
        }
      });
    }
  }

  function subjectOf(group) {
    const scene = group.scenes[0];
    const parts = [group.sweep === "layers" ? scene.scene : nameOf(scene)];
    if (group.sweep !== "resolution") parts.push(`${scene.width} × ${scene.height} pixels`);
    if (group.sweep === "resolution" || group.sweep === "samples") parts.push(`${whole(scene.triangles)} triangles`);
    return parts.join(", ");
  }

  // Settings down, steps or scenes across.
  function fillTable(parent, group, measure) {
    const table = add(add(parent, "div", undefined, { class: "scroll" }), "table");
    const head = add(add(table, "thead"), "tr");
    add(head, "th", measure.title);
    for (const scene of group.scenes) add(head, "th", scene.label ?? nameOf(scene));
    const body = add(table, "tbody");
    for (const setting of settingsOf(group.scenes)) {
      const row = add(body, "tr");
      add(row, "td", setting);
      for (const scene of group.scenes) {
        const measured = measurementOf(scene, setting);
        const cell = add(row, "td", measured ? measure.text(measure.of(measured)) + (measured.overflowed ? " †" : "") : "–");
        if (measured?.exact) cell.className = "equal";
      }
    }
  }

  function fillSkipped(parent, group) {
    const reasons = new Map(); // the steps at which a setting was skipped, by what is said of it
    for (const scene of group.scenes) {
      // Without the baseline nothing is measured.
      const all = scene.measurements.length === 0 ? scene.skipped.filter((s) => s.method === "unsorted") : scene.skipped;
      for (const skipped of all) {
        const name = scene.measurements.length === 0 ? "every method" : skipped.setting;
        const text = `${name}${skipped.samples > 1 && scene.sweep !== "samples" ? `, ${skipped.samples} samples` : ""}: ${skipped.reason}`;
        reasons.set(text, [...(reasons.get(text) ?? []), scene.label ?? nameOf(scene)]);
      }
    }
    if (reasons.size === 0) return;
    const box = add(parent, "div", "Skipped:", { class: "skipped" });
    const list = add(box, "ul");
    for (const [text, where] of reasons) {
      add(list, "li", where.length === group.scenes.length ? text : `at ${where.join(", ")}: ${text}`);
    }
  }

  function fillGroups() {
    for (const group of groups) {
      const section = add(byId("groups"), "section");
      add(section, "h2", group.sweep === null ? "Scenes" : SWEEPS[group.sweep].title);
      if (group.sweep !== null) add(section, "p", subjectOf(group), { class: "quiet" });
      const grid = add(section, "div", undefined, { class: "charts wide" });
      for (const measure of MEASURES) {
        const figure = add(grid, "figure");
        add(figure, "figcaption", measure.title);
        add(add(figure, "div", undefined, { class: "chart tall" }), "canvas", undefined,
          { id: `${group.id}-${measure.id}`, role: "img", "aria-label": `${measure.title}, as in the table below` });
      }
      for (const measure of MEASURES) fillTable(section, group, measure);
      add(section, "p", "Green: reported as exact.", { class: "quiet" });
      if (group.scenes.some((scene) => scene.measurements.some((m) => m.overflowed))) {
        add(section, "p", "† Not exact: there were more fragments than nodes, and the frame is approximate.", { class: "quiet" });
      }
      fillSkipped(section, group);
    }
  }

  // On a logarithmic axis there is no 0: what a method keeps then is not drawn.
  const drawable = (value) => (value !== null && value > 0 ? value : null);

  function datasetsOf(group, measure) {
    const isBar = group.sweep === null;
    return settingsOf(group.drawn).map((setting) => ({
      label: setting,
      data: group.drawn.map((scene) => {
        const measured = measurementOf(scene, setting);
        const y = measured ? drawable(measure.of(measured)) : null;
        return isBar ? y : { x: scene.step, y };
      }),
      hidden: hidden.has(setting), spanGaps: true, clip: 8,
      borderColor: colorOf(setting), backgroundColor: colorOf(setting),
      pointStyle: markOf(setting), pointRadius: 4, borderWidth: isBar ? 0 : 2,
    }));
  }

  function steppedAxis(group, colors) {
    const steps = group.drawn.map((scene) => scene.step);
    return {
      type: "logarithmic", min: steps[0], max: steps.at(-1) > steps[0] ? steps.at(-1) : 2 * steps[0],
      afterBuildTicks: (axis) => { axis.ticks = steps.map((value) => ({ value })); },
      grid: { color: colors.line, borderColor: colors.line },
      ticks: { color: colors.ink, autoSkip: false, callback: (value, i) => group.drawn[i].label },
      title: { display: true, text: SWEEPS[group.sweep].unit, color: colors.ink },
    };
  }

  // A logarithmic axis from a round number below all values to one above them, with ticks at 1, 2 and 5.
  function valueAxis(datasets, colors) {
    const values = datasets.flatMap((data) => data.data).map((point) => point?.y ?? point).filter(Number.isFinite);
    const ticks = [];
    for (let power = -6; power < 9; ++power) for (const digit of [1, 2, 5]) ticks.push(Number(`${digit}e${power}`));
    const min = ticks.findLast((tick) => tick < 0.97 * Math.min(...values)) ?? ticks[0];
    const max = ticks.find((tick) => tick > 1.03 * Math.max(...values)) ?? ticks.at(-1);
    return {
      type: "logarithmic", min: values.length > 0 ? min : 1, max: values.length > 0 ? max : 10,
      afterBuildTicks: (axis) => {
        axis.ticks = ticks.filter((value) => value >= axis.min && value <= axis.max).map((value) => ({ value }));
      },
      grid: { color: colors.line, borderColor: colors.line },
      ticks: { color: colors.ink, callback: (value) => String(value) },
    };
  }

  function drawChart(group, measure) {
    const colors = chartColors();
    const isBar = group.sweep === null;
    const names = group.drawn.map((scene) => scene.label ?? nameOf(scene));
    const named = { grid: { display: false, borderColor: colors.line }, ticks: { color: colors.ink } };
    const datasets = datasetsOf(group, measure);
    charts.push(new Chart(byId(`${group.id}-${measure.id}`), {
      type: isBar ? "bar" : "line",
      data: { labels: isBar ? names : undefined, datasets },
      options: {
        animation: false, maintainAspectRatio: false, interaction: { mode: "nearest", intersect: false },
        layout: { padding: { top: 8, right: 16 } },
        scales: { x: isBar ? named : steppedAxis(group, colors), y: valueAxis(datasets, colors) },
        plugins: {
          legend: { display: false },
          tooltip: { callbacks: {
            title: (items) => names[items[0].dataIndex],
            label: (item) => `${item.dataset.label}: ${measure.text(item.parsed.y)}`,
          } },
        },
      },
    }));
  }

  fillHeader();
  fillAdvice();
  fillMethods();
  fillGroups();
  keepDrawing(() => groups.forEach((group) => MEASURES.forEach((measure) => drawChart(group, measure))));
}
