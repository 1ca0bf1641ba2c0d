;;; rsl.el --- RSL in Emacs, by eglot and `rsc lsp'  -*- lexical-binding: t -*-

;; Needs Emacs 29, or an older one with the package eglot, and rsc in PATH:
;;   (load "/path/to/rsl.el")
;; For robot.json, M-x eglot in its buffer: it is served by the same server.

;;; Code:

(require 'eglot)

(defvar rsl-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?# "<" table)
    (modify-syntax-entry ?\n ">" table)
    (modify-syntax-entry ?_ "w" table)
    (modify-syntax-entry ?\' "\"" table)
    table))

;;;###autoload
(define-derived-mode rsl-mode prog-mode "RSL"
  "Programs of RoboSync."
  (setq-local comment-start "% ")
  (setq-local comment-start-skip "[%#]+\\s-*")
  ;; Behind digits % is a unit.
  (font-lock-add-keywords nil '(("\\(?:^\\|[^0-9]\\)\\(%.*\\)$" 1 font-lock-comment-face t)))
  (setq-local tab-width 2)
  (setq-local indent-tabs-mode nil)
  (setq-local indent-line-function #'indent-relative))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.rsl\\'" . rsl-mode))
(add-to-list 'eglot-server-programs '((rsl-mode) . ("rsc" "lsp")))
(add-hook 'rsl-mode-hook #'eglot-ensure)

(provide 'rsl)
;;; rsl.el ends here
