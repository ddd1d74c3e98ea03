// Fills the page with what the comparison says.
"use strict";
{
  const comparison = pageData;
  const report = comparison.report;

  const psnr = (value) => (value === null ? "∞" : value.toFixed(2));
  const flip = (value) => (value > 0 && value < 0.00005 ? "<0.0001" : value.toFixed(4));
  const ssim = (value) => (value < 1 - 1e-12 && value >= 0.99995 ? ">0.9999" : value.toFixed(4));
  const share = (value) => (value === 0 ? "0" : value < 0.0005 ? "<0.1 %" : (100 * value).toFixed(1) + " %");
  // Of the processor alone, times are by the clock and there is no baseline.
  const onProcessor = report.api === "CPU";
  const hasTimes = !report.cpu || onProcessor;
  const labelOf = (method) => method.method + (method.api === "opengl" ? ", OpenGL" : "");
  const worst = (w) => (w.difference === 0 ? "0" : `${w.difference} at ${w.x},${w.y}`);

  // What --layers and --passes said of the methods that have them.
  function limitsText() {
    const limits = [["--layers", "max_layers"], ["--passes", "passes"]].flatMap(([option, name]) => {
      const method = report.methods.find((m) => m[name] !== null);
      return method ? [`${option} ${method[name]}`] : [];
    });
    return limits.length > 0 ? ` Of the methods that have the option: ${limits.join(" ")}.` : "";
  }

  function fillHeader() {
    const name = report.scene + (report.count === null ? "" : ` × ${report.count}`);
    byId("title").textContent = `Transparency methods compared: ${name}`;
    document.title = `${name} – transparency methods compared`;
    const samples = report.samples > 1 ? `, ${report.samples} samples a pixel` : "";
    byId("subject").textContent =
      `${report.width} × ${report.height} pixels${samples}; ${whole(report.triangles)} triangles, ` +
      `${whole(report.exact_picture.fragments)} transparent fragments, up to ${report.layers_max} in one pixel.` +
      limitsText() + (report.exact_picture.exact ? "" : " The picture that all are compared with is itself not exact.");
    byId("machine").textContent = machineText(report);
    if (onProcessor) byId("cost-note").textContent = "Cost and frame are the time by the clock for the whole picture.";
  }

  function fillTable() {
    const columns = ["method", "PSNR", "SSIM", "FLIP", "worst", "off", "cost", "frame"];
    if (hasTimes) columns.push("cost, ms", "frame, ms");
    columns.push("memory, MiB");
    const table = byId("table");
    const head = add(add(table, "thead"), "tr");
    for (const column of columns) add(head, "th", column);
    const body = add(table, "tbody");
    for (const method of report.methods) {
      const m = method.metrics;
      const row = add(body, "tr");
      add(row, "td", labelOf(method));
      add(row, "td", psnr(m.psnr_db), m.psnr_db === null ? { class: "equal" } : {});
      const texts = [ssim(m.ssim), flip(m.flip), worst(m.worst), share(m.off_share), ratio(method.cost_ratio),
        ratio(method.frame_ratio)];
      if (hasTimes) texts.push(method.cost_ms.median.toFixed(3), method.frame_ms.median.toFixed(3));
      texts.push((method.memory_bytes / MIB).toFixed(1));
      for (const text of texts) add(row, "td", text);
    }
    if (report.refused.length === 0) return;
    const refused = byId("refused");
    refused.append("Left out:");
    const list = add(refused, "ul");
    for (const method of report.refused) add(list, "li", `${method.method}: ${method.reason}`);
  }

  // The pictures that the slider chooses from.
  const choices = [{ name: "exact", picture: comparison.exact }, ...comparison.methods];

  function fillSlider() {
    const show = (side) => {
      const choice = choices[byId(side).selectedIndex];
      const image = byId(`slider-${side}`);
      image.src = choice.picture;
      image.alt = choice.name;
    };
    for (const side of ["left", "right"]) {
      for (const choice of choices) add(byId(side), "option", choice.name);
      byId(side).addEventListener("change", () => show(side));
    }
    byId("left").selectedIndex = Math.max(1, choices.findIndex((choice) => choice.name === "unsorted"));
    show("left");
    show("right");
  }

  function moveSlider(percent) {
    const at = Math.min(100, Math.max(0, percent));
    byId("slider").style.setProperty("--at", `${at}%`);
    byId("handle").setAttribute("aria-valuenow", at.toFixed(1));
  }

  function wireSlider() {
    const slider = byId("slider");
    const drag = (event) => {
      const box = slider.getBoundingClientRect();
      moveSlider(((event.clientX - box.left) / box.width) * 100);
    };
    slider.addEventListener("pointerdown", (event) => {
      slider.setPointerCapture(event.pointerId);
      drag(event);
    });
    slider.addEventListener("pointermove", (event) => {
      if (slider.hasPointerCapture(event.pointerId)) drag(event);
    });
    byId("handle").addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: -2, ArrowRight: 2, Home: -100, End: 100 };
      if (!(event.key in steps)) return;
      moveSlider(Number(byId("handle").getAttribute("aria-valuenow")) + steps[event.key]);
      event.preventDefault();
    });
    moveSlider(50);
  }

  function fillPictures() {
    const pair = (name, note, first, second) => {
      const group = add(byId("pictures"), "div", undefined, { class: "pair" });
      const heading = add(group, "h3", name);
      add(heading, "small", note);
      for (const [kind, source] of [["picture", first], ["error", second]]) {
        add(add(group, "figure"), "img", undefined, { src: source, alt: `${name}, ${kind}` });
      }
    };
    comparison.methods.forEach((method, i) => {
      const m = report.methods[i].metrics;
      pair(method.name, m.psnr_db === null ? "equal to the exact picture" : `FLIP ${flip(m.flip)}, PSNR ${psnr(m.psnr_db)} dB`,
        method.picture, method.error);
    });
  }

  const gradient = (colors) => `linear-gradient(to right, ${colors.join(", ")})`;

  function fillLegends() {
    byId("error-legend").style.background = gradient(comparison.error_colors);
    byId("exact").src = comparison.exact;
    const nodes = report.exact_picture.nodes;
    byId("exact-note").textContent =
      `By ${report.exact_picture.method}${nodes ? ` with ${nodes} nodes` : ""}; all pictures are compared with it`;
    byId("layers").src = comparison.layers;
    const legend = byId("layers-legend");
    add(legend, "i").style.background = gradient(comparison.layers_colors);
    const marks = add(legend, "div");
    const most = report.layers_max;
    const parts = Math.max(1, Math.min(4, most));
    for (let i = 0; i <= parts; ++i) {
      const layers = Math.round((most * i) / parts);
      add(marks, "span", whole(layers)).style.left = `${most > 0 ? (100 * layers) / most : 0}%`;
    }
  }

  function drawChart(id, datasets, stacked, unit) {
    const { ink, line } = chartColors();
    const names = report.methods.map(labelOf);
    byId(id).parentElement.style.height = `${5 + 1.9 * names.length}rem`;
    charts.push(new Chart(byId(id), {
      type: "bar",
      data: { labels: names, datasets },
      options: {
        indexAxis: "y", animation: false, maintainAspectRatio: false,
        scales: {
          x: { stacked, beginAtZero: true, grid: { color: line, borderColor: line }, ticks: { color: ink } },
          y: { stacked, grid: { display: false, borderColor: line }, ticks: { color: ink, autoSkip: false } },
        },
        plugins: {
          legend: { display: stacked, position: "bottom", labels: { color: ink, boxWidth: 12 } },
          tooltip: { callbacks: { label: (item) => `${item.dataset.label}: ${item.parsed.x.toPrecision(3)}${unit}` } },
        },
      },
    }));
  }

  function drawCharts() {
    const methods = report.methods;
    const unit = onProcessor ? 1 : methods[0].cost_ms.median; // the baseline stands first
    byId("cost-title").textContent = onProcessor ? "Time, ms, by pass" : "Cost, times unsorted, by pass";
    const passes = [...new Set(methods.flatMap((method) => Object.keys(method.passes_ms)))].filter((p) => p !== "opaque");
    const ofPass = (method, pass) => (pass in method.passes_ms && unit > 0 ? method.passes_ms[pass].median / unit : 0);
    drawChart("cost", passes.map((pass, i) => ({
      label: pass.replaceAll("_", " "), data: methods.map((method) => ofPass(method, pass)),
      backgroundColor: colorAt(i),
    })), true, onProcessor ? " ms" : "×");
    const plain = (label, data, color) => [{ label, data, backgroundColor: color }];
    drawChart("error", plain("FLIP", methods.map((method) => method.metrics.flip), PALETTE[5]), false, "");
    drawChart("memory", plain("memory", methods.map((method) => method.memory_bytes / MIB), PALETTE[0]), false, " MiB");
  }

  document.body.classList.toggle("coarse", report.width < 640);
  fillHeader();
  fillTable();
  fillSlider();
  wireSlider();
  fillPictures();
  fillLegends();
  keepDrawing(drawCharts);
}
