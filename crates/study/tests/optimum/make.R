# Makes rubber.json beside it: Rscript make.R DESIRABILITY RSM, the folders of the unpacked source packages desirability 2.1
# and rsm 2.10.6. The data are those of Derringer and Suich (1980), table 1, as in ../optimum.rs.
arguments <- commandArgs(trailingOnly = TRUE)
script <- sub("--file=", "", grep("--file=", commandArgs(), value = TRUE))
folder <- dirname(normalizePath(script))
version <- function(package)
  paste(read.dcf(file.path(package, "DESCRIPTION"))[1, c("Package", "Version")], collapse = " ")
for (package in arguments)
  for (file in list.files(file.path(package, "R"), full.names = TRUE)) source(file)

# The rows of the table as the test has them: one list of numbers a line.
test <- readLines(file.path(folder, "..", "optimum.rs"))
begin <- grep("^const RUBBER", test)
rows <- strsplit(gsub("[][ ]", "", test[begin + 1:20]), ",")
rubber <- as.data.frame(do.call(rbind, lapply(rows, function(row) as.numeric(row[1:7]))))
names(rubber) <- c("x1", "x2", "x3", "abrasion", "modulus", "elongation", "hardness")

responses <- c("abrasion", "modulus", "elongation", "hardness")
fits <- lapply(responses, function(name) rsm(as.formula(paste(name, "~ SO(x1, x2, x3)")), data = rubber))
goals <- dOverall(dMax(120, 170), dMax(1000, 1300), dTarget(400, 500, 600), dTarget(60, 67.5, 75))
at <- function(x) {
  point <- data.frame(x1 = x[1], x2 = x[2], x3 = x[3])
  sapply(fits, predict, newdata = point)
}
all_of <- function(x) predict(goals, data.frame(t(at(x))), all = TRUE)
# Restarts of a search without slopes: the mean has kinks where a response becomes worth everything.
search <- function(start) {
  for (round in 1:40)
    start <- optim(start, function(x) if (any(abs(x) > 1)) 0 else -all_of(x)[5], control = list(reltol = 1e-16, maxit = 5000))$par
  start
}
starts <- list(c(-0.05, 0.145, -0.868), c(0.3, 0.3, -0.5), c(-0.5, 0.5, -0.8))
ends <- lapply(starts, search)
best <- ends[[which.max(sapply(ends, function(x) all_of(x)[5]))]]

number <- function(x) paste0("[", paste(sprintf("%.17g", x), collapse = ", "), "]")
table <- function(rows) paste0("[", paste(apply(rows, 1, number), collapse = ",\n    "), "]")
# Places to compare at, within the ranges and on their rim.
places <- rbind(c(0, 0, 0), c(-0.05, 0.145, -0.868), c(0.5, -0.25, 0.75), c(-1, 1, -1), c(0.1, 0.2, -0.9))
intervals <- function(fit, kind)
  predict(fit, newdata = as.data.frame(`names<-`(as.data.frame(places), c("x1", "x2", "x3"))), interval = kind)[, 2:3]
fit_text <- function(fit) {
  found <- canonical(fit, threshold = 0)
  paste0('{"eigenvalues": ', number(rev(found$eigen$values)), ', "stationary": ', number(found$xs),
    ',\n   "mean": ', table(intervals(fit, "confidence")), ',\n   "run": ', table(intervals(fit, "prediction")), "}")
}
desirabilities <- t(apply(places, 1, all_of))
writeLines(c(
  paste0('{"made_by": "', R.version.string, ", ", paste(sapply(arguments, version), collapse = ", "), '",'),
  paste0(' "places": ', table(places), ","),
  paste0(' "responses": ', table(t(apply(places, 1, at))), ","),
  paste0(' "desirabilities": ', table(desirabilities), ","),
  paste0(' "optimum": {"settings": ', number(best), ', "overall": ', sprintf("%.17g", all_of(best)[5]), "},"),
  paste0(' "fits": [', paste(sapply(fits, fit_text), collapse = ",\n  "), "]}")
), file.path(folder, "rubber.json"))
