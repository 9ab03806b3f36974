"use strict";

const ROWS_A_PAGE = 50;
const ROWS_ON_PAPER = 1000;
/* In place of a column's number: the order of the plan. */
const RUN = -1;
const data = JSON.parse(document.getElementById("runs-data").textContent);
const { columns } = data;
const total = data.drive.values.length;
const element = (id) => document.getElementById(id);
const view = { rows: Uint32Array.from({ length: total }, (_, row) => row), sorted: RUN, descending: false, page: 0, rows_a_page: ROWS_A_PAGE, open: -1 };

const runId = (row) => `${data.drive.words[data.drive.values[row]]}/${data.rest.words[data.rest.values[row]]}`;

function shown(column, row) {
  const value = column.values[row];
  if (value === null) return data.nothing;
  return column.words ? column.words[value] : value.toFixed(column.decimals);
}

/* Everything that comes from the study is set as text, never as HTML. */
function make(tag, text = "", properties = {}) {
  return Object.assign(document.createElement(tag), { textContent: text }, properties);
}

function matcher(column, needle) {
  if (!column.words) return (row) => shown(column, row).includes(needle);
  const hits = column.words.map((word) => word.toLowerCase().includes(needle));
  return (row) => column.values[row] !== null && hits[column.values[row]];
}

/* Every word of the search has to be in some column, or in the run's id. */
function searches() {
  return element("search").value.toLowerCase().split(/\s+/).filter(Boolean).map((needle) => {
    const matchers = columns.map((column) => matcher(column, needle));
    return (row) => matchers.some((matches) => matches(row)) || runId(row).toLowerCase().includes(needle);
  });
}

function choices() {
  const chosen = [...document.querySelectorAll("#filters select")].filter((select) => select.value !== "");
  return chosen.map((select) => {
    const wanted = select.value === "null" ? null : Number(select.value);
    const { values } = columns[Number(select.dataset.column)];
    return (row) => values[row] === wanted;
  });
}

/* Runs without a value come last, whichever way it is sorted. */
function ordered(rows) {
  if (view.sorted === RUN) return view.descending ? rows.reverse() : rows;
  const numbers = columns[view.sorted].values;
  const sign = view.descending ? -1 : 1;
  const compare = (a, b) => {
    if (numbers[a] === numbers[b]) return a - b;
    if (numbers[a] === null) return 1;
    if (numbers[b] === null) return -1;
    return sign * (numbers[a] - numbers[b]);
  };
  return rows.sort(compare);
}

function update() {
  const tests = [...choices(), ...searches()];
  const all = Uint32Array.from({ length: total }, (_, row) => row);
  view.rows = ordered(tests.length ? all.filter((row) => tests.every((test) => test(row))) : all);
  view.page = 0;
  draw();
}

function cell(column, row) {
  const td = make("td", shown(column, row));
  if (!column.words) td.className = "number";
  if (column.heading === "outcome") td.className = td.textContent.match(/^(success|failed|)/)[0];
  return td;
}

function line(row) {
  const tr = make("tr");
  const button = make("button", String(row + 1), { type: "button", className: "open" });
  button.setAttribute("aria-label", `run ${row + 1}: details`);
  const th = make("th");
  th.scope = "row";
  th.append(button);
  tr.append(th, ...columns.map((column) => cell(column, row)));
  tr.dataset.row = row;
  return tr;
}

function draw() {
  const pages = Math.max(1, Math.ceil(view.rows.length / view.rows_a_page));
  view.page = Math.min(Math.max(view.page, 0), pages - 1);
  const from = view.page * view.rows_a_page;
  const rows = view.rows.slice(from, from + view.rows_a_page);
  document.querySelector("#runs-table tbody").replaceChildren(...Array.from(rows, line));
  const found = view.rows.length.toLocaleString("en");
  element("count").textContent = view.rows.length === total ? `${found} runs` : `${found} of ${total.toLocaleString("en")} runs`;
  const ends = [from + 1, from + rows.length].map((row) => row.toLocaleString("en"));
  element("place").textContent = `Rows ${ends[0]} to ${ends[1]} of ${found}`;
  element("first").disabled = element("previous").disabled = view.page === 0;
  element("next").disabled = element("last").disabled = view.page === pages - 1;
  document.querySelector("#runs-table .pages").hidden = pages === 1;
  headings().forEach((th, k) => {
    const order = view.descending ? "descending" : "ascending";
    th.setAttribute("aria-sort", k - 1 === view.sorted ? order : "none");
  });
}

const headings = () => [...document.querySelectorAll("#runs-table thead th")];

function sortBy(column) {
  view.descending = view.sorted === column && !view.descending;
  view.sorted = column;
  update();
}

function heading(text, column, number) {
  const th = make("th", "", { scope: "col", className: number ? "number" : "" });
  const button = make("button", text, { type: "button" });
  button.addEventListener("click", () => sortBy(column));
  th.append(button);
  return th;
}

function filter(column, k) {
  const label = make("label", `${column.heading} `);
  const select = make("select");
  select.dataset.column = k;
  select.append(make("option", "all", { value: "" }));
  column.words.forEach((word, code) => select.append(make("option", word, { value: code })));
  if (column.values.includes(null)) select.append(make("option", data.nothing, { value: "null" }));
  label.append(select);
  return label;
}

function facts(row, told) {
  const list = make("dl", "", { className: "facts" });
  columns.filter((column) => column.words || !told).forEach((column) => {
    const group = make("div");
    group.append(make("dt", column.heading), make("dd", shown(column, row)));
    list.append(group);
  });
  return list;
}

function quoted(text) {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'"'"'`)}'`;
}

/* A run that could not be begun has no folder; that over a recorded sequence tells itself how it is repeated. */
function ending(row, told) {
  const kind = data.kind.words[data.kind.values[row]];
  if (kind === "none") return [];
  const id = runId(row);
  const link = make("a", "Its folder", { href: data.runs_url + id.split("/").map(encodeURIComponent).join("/") + "/" });
  const where = make("p", told ? "" : "There was no room in this page for its map and timeline. ");
  where.append(link, " has all its files.");
  if (kind === "sequence") return [where];
  const repeat = make("p", "Repeat it: ");
  repeat.append(make("code", `slamgym run --like ${quoted(data.runs_folder + id)} --out again`));
  return [where, repeat];
}

function open(row) {
  const template = element(`run-${row}`);
  element("run-title").textContent = `Run ${row + 1}`;
  element("run-body").replaceChildren(
    make("p", runId(row), { className: "id" }),
    facts(row, template !== null),
    ...(template ? [template.content.cloneNode(true)] : []),
    ...ending(row, template !== null),
  );
  const place = view.rows.indexOf(row);
  element("before").disabled = place <= 0;
  element("after").disabled = place < 0 || place === view.rows.length - 1;
  view.open = row;
  if (!element("run").open) element("run").showModal();
  element("run-body").scrollTop = 0;
}

function openPicture(figure) {
  element("picture-title").textContent = figure.querySelector("h3").textContent;
  element("picture-body").replaceChildren(figure.querySelector("img").cloneNode());
  element("picture").showModal();
}

/* Paper has no next page to click at. */
function onPaper() {
  const { page } = view;
  Object.assign(view, { page: 0, rows_a_page: ROWS_ON_PAPER });
  draw();
  addEventListener("afterprint", () => {
    Object.assign(view, { page, rows_a_page: ROWS_A_PAGE });
    draw();
  }, { once: true });
}

function turn(by) {
  view.page = by(view.page);
  draw();
}

element("filters").append(...columns.flatMap((column, k) => (column.filtered ? [filter(column, k)] : [])));
element("filters").addEventListener("input", update);
element("filters").addEventListener("submit", (event) => event.preventDefault());
document.querySelector("#runs-table thead").append(make("tr"));
document.querySelector("#runs-table thead tr").append(
  heading("run", RUN, true),
  ...columns.map((column, k) => heading(column.heading, k, !column.words)),
);
document.querySelector("#runs-table tbody").addEventListener("click", (event) => {
  const tr = event.target.closest("tr");
  if (tr && !String(getSelection())) open(Number(tr.dataset.row));
});
element("first").addEventListener("click", () => turn(() => 0));
element("previous").addEventListener("click", () => turn((page) => page - 1));
element("next").addEventListener("click", () => turn((page) => page + 1));
element("last").addEventListener("click", () => turn(() => Infinity));
element("close").addEventListener("click", () => element("run").close());
element("before").addEventListener("click", () => open(view.rows[view.rows.indexOf(view.open) - 1]));
element("after").addEventListener("click", () => open(view.rows[view.rows.indexOf(view.open) + 1]));
for (const figure of document.querySelectorAll(".picture")) {
  const button = figure.querySelector(".full");
  button.hidden = false;
  for (const target of [button, figure.querySelector("img")]) target.addEventListener("click", () => openPicture(figure));
}
element("picture-close").addEventListener("click", () => element("picture").close());
addEventListener("beforeprint", onPaper);
element("runs-table").hidden = false;
draw();
