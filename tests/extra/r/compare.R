# Computes the tables of tables.py again and says how far R is from what stands there.
suppressPackageStartupMessages({ library(lmerTest); library(emmeans) })
options(contrasts = c("contr.sum", "contr.poly"), emmeans = list(msg.interaction = FALSE))

# What is known to fewer digits than 1e-8: maxima; what lme4 looks for step by step; the studentized range, of which R is 2e-5 off where
# p is 5e-5 with 4 degrees of freedom, and the sum over a grid is as plateau.study says; and integrals at random points.
tolerance <- function(check, key) {
    if (check == "power" && key == "best") return(1e-6)
    if (check == "slopes" && key != "coefficient") return(1e-4)
    if (startsWith(check, "tukey") && key %in% c("p", "reach")) return(if (key == "p") 5e-5 else 1e-6)
    if (startsWith(check, "dunnett") && key %in% c("p", "reach")) 2e-3 else 1e-8
}

fitted_to <- function(case, data, ...) lm(reformulate(c(if (case$blocks) "rep", case$terms), "y"), data, ...)

variances <- function(case, data) {
    found <- car::Anova(fitted_to(case, data), type = 3)
    rows <- found[c(if (case$blocks) "rep", case$terms, "Residuals"), ]
    tested <- found[if (case$blocks) "rep" else case$terms, ]
    list(freedom = rows$Df, squares = rows$`Sum Sq`, f = tested$`F value`, p = tested$`Pr(>F)`)
}

with_strata <- function(case, data) {
    data[] <- lapply(names(data), function(name) if (name == "y") data$y else factor(data[[name]]))
    formula <- reformulate(c(case$terms, sprintf("Error(rep/(%s))", paste(case$terms, collapse = " + "))), "y")
    eval(bquote(aov(.(formula), .(data))))
}

strata <- function(case, data) {
    found <- summary(with_strata(case, data))
    rows <- sapply(case$terms, function(term) {
        one <- found[[paste0("Error: rep:", term)]][[1]]
        c(one["Residuals", "Df"], unlist(one[trimws(rownames(one)) == term, c("F value", "Pr(>F)")]))
    })
    list(freedom = rows[1, ], f = rows[2, ], p = rows[3, ])
}

slopes <- function(case, data) {
    names <- paste0("t", seq_along(case$terms))
    data[names] <- lapply(strsplit(case$terms, ":"), function(factors) Reduce(`*`, data[factors]))
    control <- lmerControl("bobyqa", calc.derivs = FALSE, optCtrl = list(rhoend = 1e-12), check.conv.singular = "ignore")
    fit <- lmer(reformulate(c(names, "(1 | rep)", sprintf("(0 + %s | rep)", names)), "y"), data, control = control)
    found <- coef(summary(fit))[names, ]
    variance <- as.data.frame(lme4::VarCorr(fit))
    # Where seeds x term is no more than the noise, lme4 takes the error from the residual.
    found[variance$vcov[match(names, variance$var1)] < 1e-4 * sigma(fit)^2, c("Std. Error", "df")] <- NA
    list(coefficient = found[, "Estimate"], error = found[, "Std. Error"], freedom = found[, "df"])
}

differences <- function(case, data, method, name) {
    straight <- names(Filter(is.numeric, data[names(data) != "y"]))
    fit <- if (case$blocks) with_strata(case, data) else fitted_to(case, data)
    means <- emmeans(fit, name, at = sapply(straight, function(one) 0, simplify = FALSE))
    set.seed(1)
    found <- summary(switch(method, tukey = contrast(means, "pairwise", adjust = "tukey"),
        dunnett = contrast(means, "trt.vs.ctrl", ref = nlevels(data[[name]]), adjust = "mvt")), infer = TRUE)
    # Pairs are in the same order, with the other sign.
    list(difference = found$estimate * if (method == "tukey") -1 else 1, standard_error = found$SE, freedom = found$df, p = found$p.value,
        reach = (found$upper.CL - found$lower.CL) / (2 * found$SE))
}

power <- function(case, data) {
    fit <- fitted_to(case, data, y = TRUE, qr = TRUE)
    likelihood <- function(at) sapply(at, function(one) MASS::boxcox(fit, one, plotit = FALSE, interp = FALSE, eps = 1e-7)$y)
    best <- optimize(likelihood, c(-5, 5), maximum = TRUE, tol = 1e-10)
    beyond <- function(at) likelihood(at) - best$objective + qchisq(0.95, 1) / 2
    ends <- sapply(c(-5, 5), function(most) if (beyond(most) > 0) NA else uniroot(beyond, range(best$maximum, most), tol = 1e-12)$root)
    list(best = best$maximum, ends = ends)
}

polynomial <- function(case, data) {
    fit <- fitted_to(case, data)
    one <- predict(fit, as.data.frame(case$points), se.fit = TRUE, interval = "prediction")
    left_out <- residuals(fit) / (1 - hatvalues(fit))
    # The interval of one run in R, or as much wider as errors at points that were left out are larger than residuals.
    reach <- (one$fit[, "upr"] - one$fit[, "fit"]) * sqrt(max(mean(residuals(fit) * left_out) / sigma(fit)^2, 1))
    found <- list(value = one$fit[, "fit"], leverage = (one$se.fit / one$residual.scale)^2, `left out` = left_out)
    c(found, list(mean_low = found$value - reach, mean_high = found$value + reach))
}

distance <- function(said, told, check, key) {
    if (length(said) != length(told) || all(is.na(told)) || anyNA(said[!is.na(told)])) return(Inf)
    # Numbers near 0 have the digits of the largest ones of their kind.
    least <- if (key == "p" && grepl(" ", check)) 1 else 1e-3 * max(abs(told), na.rm = TRUE)
    max(abs(said - told) / pmax(abs(told), least), na.rm = TRUE)
}

failed <- FALSE
for (case in jsonlite::read_json(commandArgs(TRUE)[1], simplifyVector = TRUE, simplifyDataFrame = FALSE)) {
    data <- as.data.frame(case$runs, stringsAsFactors = TRUE)
    for (check in names(case$said)) {
        how <- switch(check, anova = variances, strata = strata, slopes = slopes, power = power, polynomial = polynomial, differences)
        told <- do.call(how, c(list(case, data), if (grepl(" ", check)) strsplit(check, " ")[[1]]))
        said <- case$said[[check]]
        worst <- sapply(names(said), function(key) distance(as.numeric(said[[key]]), as.numeric(told[[key]]), check, key))
        is_far <- worst > sapply(names(said), tolerance, check = check)
        failed <- failed || any(is_far)
        cat(sprintf("%s: %s: %s\n", case$name, check, paste0(names(said), " ", signif(worst, 2), ifelse(is_far, " TOO FAR", ""), collapse = ", ")))
    }
}
quit(status = as.integer(failed))
